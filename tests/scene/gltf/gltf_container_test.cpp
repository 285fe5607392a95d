// Where a glTF file's bytes lie: GLB chunks, data in URIs, files beside it and elsewhere.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "scene/gltf/gltf_loader.hpp"
#include "scene/warning_texts.hpp"

namespace luciole::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string word(std::size_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * i & 0xff);
  return bytes;
}
std::string chunk(const std::string& kind, const std::string& data) {
  return word(data.size()) + kind + data;
}
std::string glb(const std::string& chunks, std::size_t more = 0) {
  return "glTF" + word(2) + word(12 + chunks.size() + more) + chunks;
}
const std::string kJson = "JSON", kBin("BIN\0", 4);

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t j = i; j < i + 3; ++j)
      bits = bits << 8 | (j < bytes.size() ? static_cast<unsigned char>(bytes[j]) : 0u);
    for (int digit = 0; digit < 4; ++digit)
      text += i + std::size_t(digit) > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * digit) & 63];
  }
  return text;
}

class GltfContainer : public GltfLoader {
 protected:
  Scene loadBytes(const std::string& bytes, const std::vector<std::string>& search = {}) {
    std::ofstream(folder / "a.gltf", std::ios::binary) << bytes;
    Scene scene;
    loadGltf(folder / "a.gltf", scene, {}, search);
    return scene;
  }
  std::string fault(const std::string& bytes) {
    try {
      loadBytes(bytes);
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), testing::Not(HasSubstr("\n")));
      return e.what();
    }
    return "no error";
  }
  /// The JSON of a triangle, padded to four bytes.
  std::string json4(const nlohmann::json& buffer) {
    file.root["buffers"] = {buffer};
    std::string text = file.root.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    return text;
  }
  std::string withUri(const std::string& uri, std::size_t length = 36) {
    return json4({{"byteLength", length}, {"uri", uri}});
  }
  std::string inGlb() { return json4({{"byteLength", 36}}); }

  GltfFile file = triangleFile();
};

TEST_F(GltfContainer, DataMayBeLongerThanItsBufferSaysButNotShorter) {
  std::ofstream(folder / "data.bin", std::ios::binary) << file.data << "and more";
  EXPECT_THAT(loadBytes(withUri("data.bin")).warnings, IsEmpty());
  EXPECT_THAT(loadBytes(withUri("data:;base64," + base64(file.data + "more"))).warnings, IsEmpty());
  EXPECT_THAT(loadBytes(glb(chunk(kJson, inGlb()) + chunk(kBin, file.data + "more"))).warnings, IsEmpty());
  const std::string shorter = file.data.substr(0, 35);
  std::ofstream(folder / "data.bin", std::ios::binary) << shorter;
  for (const std::string& bytes : {withUri("data.bin"), withUri("data:;base64," + base64(shorter)),
                                   glb(chunk(kJson, inGlb()) + chunk(kBin, shorter))})
    EXPECT_THAT(fault(bytes), HasSubstr("buffers[0]: byteLength is 36, but there are only 35 bytes"));
  EXPECT_THAT(
      textsOf(loadBytes(withUri("data:;base64," + base64(file.data), 30)).warnings),
      ElementsAre(HasSubstr("bufferViews[0]: 36 bytes from 0 on reach past its buffer's byteLength 30")));
}

TEST_F(GltfContainer, ChunksMayBeEmptyUnknownUnpaddedOrFollowedByMore) {
  const std::string inline_json = withUri("data:;base64," + base64(file.data)), bin = chunk(kBin, file.data);
  EXPECT_THAT(loadBytes(glb(chunk(kJson, inline_json) + chunk(kBin, ""))).warnings, IsEmpty());
  EXPECT_THAT(loadBytes(glb(chunk(kJson, inline_json))).warnings, IsEmpty());
  EXPECT_THAT(
      loadBytes(glb(chunk(kJson, inGlb()) + chunk("MINE", "12345678") + bin + chunk("MORE", ""))).warnings,
      IsEmpty());
  const auto told = [&](const std::string& bytes) {
    const Scene scene = loadBytes(bytes);
    EXPECT_EQ(scene.objects.size(), 1u);
    for (const Warning& warning : scene.warnings) EXPECT_TRUE(warning.repaired);
    return textsOf(scene.warnings);
  };
  EXPECT_THAT(told(glb(chunk(kJson, inGlb()) + bin) + "\n"), ElementsAre(HasSubstr("its header: length is")));
  EXPECT_THAT(told(glb(chunk(kJson, inGlb()) + bin, 4)), ElementsAre(HasSubstr("its header: length is")));
  for (int blanks = 1; blanks < 4; ++blanks) {
    std::string odd = inGlb();
    while (odd.back() == ' ') odd.pop_back();
    odd.resize((odd.size() + 3) / 4 * 4 + std::size_t(blanks), ' ');
    EXPECT_THAT(told(glb(chunk(kJson, odd) + bin)), ElementsAre(HasSubstr("its JSON chunk: "))) << blanks;
    EXPECT_THAT(told(glb(chunk(kJson, odd) + std::string(std::size_t(4 - blanks), ' ') + bin)),
                ElementsAre(HasSubstr("its JSON chunk: ")))
        << blanks << ", padded, but not counted";
  }
  EXPECT_THAT(told(glb(chunk(kJson, inGlb() + std::string(4, '\0')) + bin)),
              ElementsAre(HasSubstr("its JSON: ends in 4 zeros, expected blanks")));
  const std::string json = chunk(kJson, inGlb());
  EXPECT_THAT(told(glb(json + word(40) + kBin + file.data)),
              ElementsAre(HasSubstr(fmt::format("its chunks: end at byte {}, the file at {}",
                                                json.size() + 60, json.size() + 56))));
  EXPECT_THAT(told(glb(json + bin + "abc")), ElementsAre(HasSubstr("its chunks: end at byte")));
  EXPECT_THAT(told(glb(json + chunk(kBin, file.data + "x"))),
              ElementsAre(HasSubstr("its BIN chunk: 37 bytes, expected a multiple of 4")));
  EXPECT_THAT(told(glb(json + chunk(kBin, file.data + "x") + std::string(3, '\0'))),
              ElementsAre(HasSubstr("its BIN chunk: 37 bytes")));
  EXPECT_THAT(told(glb(bin + json)), ElementsAre(HasSubstr("its JSON chunk: is not the first")));
  EXPECT_THAT(told(glb(chunk("MINE", "1234") + json + bin)),
              ElementsAre(HasSubstr("its JSON chunk: is not the first")));
}

TEST_F(GltfContainer, DataThatNoViewNeedsMayBeMissing) {
  const auto told = [&](const std::string& bytes) {
    const Scene scene = loadBytes(bytes);
    EXPECT_EQ(scene.objects.size(), 1u);
    for (const Warning& warning : scene.warnings) EXPECT_TRUE(warning.repaired);
    return textsOf(scene.warnings);
  };
  const char* const what = "buffers[0]: byteLength is 40, but there are only 36 bytes";
  std::ofstream(folder / "data.bin", std::ios::binary) << file.data;
  EXPECT_THAT(told(withUri("data.bin", 40)), ElementsAre(HasSubstr(what)));
  EXPECT_THAT(told(withUri("data:;base64," + base64(file.data), 40)), ElementsAre(HasSubstr(what)));
  EXPECT_THAT(told(glb(chunk(kJson, json4({{"byteLength", 40}})) + chunk(kBin, file.data))),
              ElementsAre(HasSubstr(what)));
  EXPECT_THAT(told(glb(chunk(kJson, withUri("", 36)) + chunk(kBin, file.data))),
              ElementsAre(HasSubstr("buffers[0]: uri is '', taken for none")));
}

TEST_F(GltfContainer, OnlyTheFirstBufferIsTheGlbs) {
  file.root["buffers"] = {{{"byteLength", 36}}, {{"byteLength", 36}}};
  file.root["bufferViews"][0]["buffer"] = 1;
  std::string json = file.root.dump();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  EXPECT_THAT(fault(glb(chunk(kJson, json) + chunk(kBin, file.data))),
              HasSubstr("buffers[1] has no uri, and is not a GLB's first"));
}

TEST_F(GltfContainer, WhatIsNoGlbIsRefused) {
  EXPECT_THAT(fault("glTF"), HasSubstr("is no GLB file: it is cut short"));
  EXPECT_THAT(fault("glTF" + word(1) + word(20) + chunk(kJson, "")), HasSubstr("version 1, expected 2"));
  EXPECT_THAT(fault(glb(chunk(kBin, "12345678"))), HasSubstr("it has no JSON chunk"));
  EXPECT_THAT(fault(glb(word(4000) + kJson + "{}")), HasSubstr("its JSON has 4000 bytes, but only 2 follow"));
  EXPECT_THAT(fault(glb(chunk(kJson, inGlb()))),
              HasSubstr("buffers[0] has no uri, and the file no BIN chunk"));
}

TEST_F(GltfContainer, AByteOrderMarkIsNotPartOfTheText) {
  const std::string text = withUri("data:;base64," + base64(file.data));
  EXPECT_THAT(loadBytes("\xef\xbb\xbf" + text).warnings, IsEmpty());
  EXPECT_THAT(loadBytes(glb(chunk(kJson, "\xef\xbb\xbf " + text))).warnings, IsEmpty());
}

TEST_F(GltfContainer, DataOfAnyMediaTypeAndCodingIsRead) {
  std::string escaped, half;
  for (const char c : file.data) {
    constexpr const char* kHex = "0123456789aBcDeF";
    escaped += {'%', kHex[c >> 4 & 15], kHex[c & 15]};
  }
  const std::string text = base64(file.data);
  for (const char c : text)
    half += c == '+' ? "%2B" : c == '/' ? "%2f" : c == '=' ? "%3D" : std::string(1, c);
  std::string lines = text;
  lines.insert(20, "\r\n ");
  std::string bare = text;
  while (bare.back() == '=') bare.pop_back();
  for (const std::string& uri :
       {"data:application/octet-stream;base64," + text, "data:application/gltf-buffer;base64," + text,
        "data:;base64," + text, "data:application/octet-stream;charset=utf-8;base64," + text,
        "DATA:made/up;a=b;BASE64," + text, "data:application/octet-stream," + escaped, "data:;base64," + half,
        "data:;base64," + lines, "data:;base64," + bare, "data:a/b; base64 ," + text,
        "data:a/b;base64;charset=utf-8," + text}) {
    const Scene scene = loadBytes(withUri(uri));
    EXPECT_EQ(scene.meshes.at(0).positions.at(1), glm::vec3(1, 0, 0)) << uri;
    EXPECT_THAT(scene.warnings, IsEmpty()) << uri;
  }
  EXPECT_THAT(fault(withUri("data:;base64,AA*A")), HasSubstr("buffers[0].uri: its data is not base64"));
  EXPECT_THAT(fault(withUri("data:;base64")), HasSubstr("buffers[0].uri: is a data URI without a comma"));
}

TEST_F(GltfContainer, FilesAreFoundByTheirUri) {
  std::filesystem::create_directories(folder / "sub");
  std::filesystem::create_directories(folder / "else/deep");
  for (const char* name :
       {"sub/a b.bin", "c%20d.bin", "100% e.bin", "else/f.bin", "else/deep/g.bin", "h.bin"})
    std::ofstream(folder / name, std::ios::binary) << file.data;
  for (const char* uri :
       {"sub/a%20b.bin", "sub/a b.bin", "sub\\a b.bin", ".\\sub\\a%20b.bin", "c%2520d.bin", "c%20d.bin",
        "100% e.bin", "h.bin?v=3", "h.bin#part", "sub/a%20b.bin?x=/y", " h.bin\n", "f.bin", "deep/g.bin",
        "C:\\Users\\me\\h.bin", "/home/me/h.bin", "file:///C:/me/h.bin"})
    EXPECT_THAT(loadBytes(withUri(uri), {folder / "else"}).warnings, IsEmpty()) << uri;
  EXPECT_THAT(loadBytes(withUri("file://" + (folder / "sub/a%20b.bin"))).warnings, IsEmpty());
  EXPECT_THAT(fault(withUri("nowhere\\x.bin")), HasSubstr("buffers[0]: there is no file 'nowhere\\x.bin'"));
  EXPECT_THAT(fault(withUri("sub")), HasSubstr("buffers[0]: there is no file 'sub'"));
}

TEST_F(GltfContainer, PicturesAreFoundInTheirFoldersAndMissingOnesToldAllAtOnce) {
  std::filesystem::create_directories(folder / "else");
  writePicture("else/there.png", {1, 0, 0});
  for (const char* name : {"x\\there.png", "no.png", "C:\\no2.png"}) {
    const int number = static_cast<int>(file.root["images"].size());
    file.root["images"].push_back({{"uri", name}});
    file.root["textures"].push_back({{"source", number}});
    file.root["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", number}}}}}});
    nlohmann::json primitive = file.primitive();
    primitive["material"] = number;
    file.root["meshes"][0]["primitives"].push_back(primitive);
  }
  const Scene scene = loadBytes(withUri("data:;base64," + base64(file.data)), {folder / "else"});
  EXPECT_THAT(scene.missing_textures, ElementsAre(HasSubstr("images[1]: there is no picture 'no.png'"),
                                                  HasSubstr("images[2]: there is no picture 'C:\\no2.png'")));
  EXPECT_EQ(scene.textures.size(), 1u);
}

TEST_F(GltfContainer, TextThatIsNoUtf8IsTakenForLatin1) {
  std::string text = withUri("data:;base64," + base64(file.data));
  text.replace(text.find("\"mesh\":0"), 8,
               "\"name\":\"k\xfc"
               "che \xc3\xbc\",\"mesh\":0");
  const Scene scene = loadBytes(text);
  EXPECT_EQ(scene.objects.at(0).name,
            "k\xc3\xbc"
            "che \xc3\xbc");
  EXPECT_THAT(textsOf(scene.warnings), ElementsAre(HasSubstr("is not UTF-8")));
  EXPECT_TRUE(scene.warnings.at(0).repaired);
  for (const char* bytes : {"\xc0\xaf", "\xed\xa0\x80", "\xf5\x80\x80\x80", "\xe2\x82", "\xff"}) {
    text = withUri("data:;base64," + base64(file.data));
    text.replace(text.find("\"mesh\":0"), 8, std::string("\"name\":\"") + bytes + "\",\"mesh\":0");
    EXPECT_EQ(loadBytes(text).warnings.size(), 1u) << bytes;
  }
}

TEST_F(GltfContainer, FilesWithNamesInLatin1AreFound) {
  std::ofstream(folder / "k\xfc.bin", std::ios::binary) << file.data;
  std::string text = withUri("k?.bin");
  text[text.find("k?") + 1] = '\xfc';
  EXPECT_THAT(textsOf(loadBytes(text).warnings), ElementsAre(HasSubstr("is not UTF-8")));
  EXPECT_THAT(loadBytes(withUri("k%FC.bin")).warnings, IsEmpty());
  EXPECT_THAT(loadBytes(withUri("k%C3%BC.bin")).warnings, IsEmpty());
}

TEST_F(GltfContainer, EscapesOfHalfALetterAreMended) {
  const struct {
    const char *written, *name;
  } kNames[] = {{R"(k\udcfcche)",
                 "k\xc3\xbc"
                 "che"},
                {R"(a\ud800b)",
                 "a\xef\xbf\xbd"
                 "b"},
                {R"(\ud83d\ude00\udfff\\ud800)", "\xf0\x9f\x98\x80\xef\xbf\xbd\\ud800"}};
  for (const auto& [written, name] : kNames) {
    std::string text = withUri("data:;base64," + base64(file.data));
    text.replace(text.find("\"mesh\":0"), 8, std::string("\"name\":\"") + written + "\",\"mesh\":0");
    const Scene scene = loadBytes(text);
    EXPECT_EQ(scene.objects.at(0).name, name) << written;
    EXPECT_THAT(textsOf(scene.warnings), ElementsAre(HasSubstr("its JSON: has escapes of half a letter")));
  }
}

TEST_F(GltfContainer, WhatIsNoJsonIsRefusedInALine) {
  EXPECT_THAT(fault(std::string("{}\0{}", 5)), HasSubstr("is not valid JSON: byte 3 is 0"));
  for (const char* text : {"", "\xef\xbb\xbf", "{", "[1, 2", "{\"asset\": \xff", "nonsense"})
    EXPECT_THAT(fault(text), HasSubstr("a.gltf: is not valid JSON: ")) << text;
  EXPECT_THAT(fault("[]"), HasSubstr("its JSON: expected an object"));
}

}  // namespace
}  // namespace luciole::test
