#include "scene/obj/obj_file.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "luciole/error.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

class ObjParts : public testing::Test {
 protected:
  ObjFile read(const std::string& text, std::size_t part_bytes) {
    test::writeText(folder_ / "a.obj", text);
    return readObjFile(folder_ / "a.obj", part_bytes);
  }
  std::string error(const std::string& text, std::size_t part_bytes) {
    try {
      read(text, part_bytes);
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  }

 private:
  const test::TemporaryFolder folder_;
};

void expectEqual(const ObjFile& a, const ObjFile& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.colors, b.colors);
  EXPECT_EQ(a.uvs, b.uvs);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.material_names, b.material_names);
  EXPECT_EQ(a.material_files, b.material_files);
  EXPECT_EQ(a.warnings, b.warnings);
  EXPECT_EQ(a.has_lines, b.has_lines);
  ASSERT_EQ(a.parts.size(), b.parts.size());
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    EXPECT_EQ(a.parts[i].name, b.parts[i].name) << i;
    EXPECT_EQ(a.parts[i].is_object, b.parts[i].is_object) << i;
  }
  ASSERT_EQ(a.corners.size(), b.corners.size());
  for (std::size_t i = 0; i < a.corners.size(); ++i) {
    EXPECT_EQ(a.corners[i].position, b.corners[i].position) << i;
    EXPECT_EQ(a.corners[i].uv, b.corners[i].uv) << i;
    EXPECT_EQ(a.corners[i].normal, b.corners[i].normal) << i;
  }
  ASSERT_EQ(a.faces.size(), b.faces.size());
  for (std::size_t i = 0; i < a.faces.size(); ++i) {
    EXPECT_EQ(a.faces[i].first_corner, b.faces[i].first_corner) << i;
    EXPECT_EQ(a.faces[i].corner_count, b.faces[i].corner_count) << i;
    EXPECT_EQ(a.faces[i].material, b.faces[i].material) << i;
    EXPECT_EQ(a.faces[i].smoothing, b.faces[i].smoothing) << i;
    EXPECT_EQ(a.faces[i].part, b.faces[i].part) << i;
  }
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

/// Everything that reaches from one line into later ones.
const std::string kText =
    "\xef\xbb\xbf# a comment that ends in \\\nmtllib a.mtl\nf 1 2 3\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\n"
    "v 0 1 \\  \n 0 0 \\\n 0 1\nvt 0.5 0.25\nvn 0 0 1\nf -3/-1/-1 -2//-1 3\n\nusemtl red\nf 1 2 3\ns 2\n"
    "f 1 2 3\ng x\nusemtl blue light\nf 1 2 \\\n3 4\ns\nf 4 3 2\nv 1 1 1\ns off\nf -1 -2 -3\no y  z\n"
    "vn 1 0 0\nvn 0 1 nan\nvt -nan(ind)\nf 1/7 2/-9/4 3/0\nf 1 2\nl 1 2\nf 1//-1 2//-2 3//-3\nmtllib b.mtl "
    "c.mtl\ns on\nf -4 -3 -2 -1\nf 1 2\\\n 3\\";

TEST_F(ObjParts, AFileInPartsIsTheFileInOneWhereverItIsCut) {
  for (const char* ends : {"\n", "\r\n", "\r"}) {
    for (const bool smoothing : {true, false}) {
      std::string text = replaced(kText, "\n", ends);
      if (!smoothing) text = replaced(text, std::string(ends) + "s", std::string(ends) + "o");
      const ObjFile whole = read(text, text.size());
      ASSERT_EQ(whole.positions.size(), 4u);
      ASSERT_EQ(whole.colors.size(), 4u);
      ASSERT_EQ(whole.colors[3], glm::dvec3(-1)) << "none";
      ASSERT_EQ(whole.normals.size(), 3u);
      ASSERT_EQ(whole.faces.size(), 11u);
      ASSERT_EQ(whole.warnings.size(), 6u);
      ASSERT_EQ(whole.faces[1].first_corner, 3u);
      ASSERT_EQ(whole.corners[3].position, 0);
      ASSERT_EQ(whole.faces[5].smoothing, smoothing ? 2u : 1u);
      for (std::size_t part = 1; part < text.size(); ++part) {
        SCOPED_TRACE(testing::Message() << "parts of " << part);
        expectEqual(read(text, part), whole);
      }
    }
  }
}

TEST_F(ObjParts, MistakesNameTheSameLineWhereverTheFileIsCut) {
  const std::string text_of_all = replaced(kText, "\xef\xbb\xbf", "");
  const std::string good = text_of_all.substr(0, text_of_all.size() - 1);  // no line after it continues it
  for (const std::string& text :
       {good + "\nv 1 2\n", "v nan 0 0\n" + good, good + "\nf 1 2 9\nf 1 2 9\n", good + "\nf -5 1 2\n",
        "f -1 1 2\n" + good, good + "\nf 0 1 2", replaced(good, "s 2\n", "f 1/2 2 3\nf 1/2/9 3/7 1/2/3/4\n"),
        replaced(good, "g x", "v 1 x 1") + "\nf 1 2 9\n"}) {
    const std::string whole = error(text, text.size());
    ASSERT_NE(whole.find("a.obj: line "), whole.npos) << text;
    for (std::size_t part = 1; part < text.size(); ++part) ASSERT_EQ(error(text, part), whole) << part;
  }
}

TEST_F(ObjParts, AFileWhoseLinesAllGoOnIsOnePart) {
  const std::string text = replaced("v 1 2 3 v 4 5 6 v 7 8 9", " ", " \\\n ");
  const ObjFile whole = read(text, text.size());
  EXPECT_EQ(whole.positions.size(), 1u);
  expectEqual(read(text, 1), whole);
}

TEST_F(ObjParts, RealFilesAreTheSameInPartsOfAnySize) {
  LUCIOLE_NEEDS_SHARED();
  for (const char* file : {"utah_teapot/teapot.obj", "quake_e1m1/e1m1.obj"}) {
    const std::string path = (test::sharedScenes() / file).string();
    const ObjFile whole = readObjFile(path, std::size_t(1) << 40);
    for (const std::size_t part : {1u, 1000u, 65536u}) expectEqual(readObjFile(path, part), whole);
  }
}

}  // namespace
}  // namespace luciole
