// What the READMEs tell a reader to type works as they say it.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <sstream>
#include <utility>

#include "cli/run_program.hpp"

namespace luciole::test {
namespace {

const std::string kSource = LUCIOLE_SOURCE_DIR;

/// Everything the file shows as a call of the program: lines of its ```sh blocks, and `./luciole …` in the
/// text and under the pictures. Not the test command, which would call this test.
std::vector<std::string> commandsOf(const std::string& readme) {
  std::istringstream lines(readText(kSource + "/" + readme));
  const std::regex quoted("`(\\./luciole [^`]+)`");
  std::vector<std::string> commands;
  bool in_block = false, in_shell = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("```", 0) == 0) {
      in_block = !in_block;
      in_shell = in_block && line == "```sh";
    } else if (in_shell && line.rfind("./luciole ", 0) == 0) {
      commands.push_back(line);
    } else if (!in_block) {
      for (auto i = std::sregex_iterator(line.begin(), line.end(), quoted); i != std::sregex_iterator(); ++i)
        commands.push_back((*i)[1]);
    }
  }
  std::erase_if(commands, [](const std::string& command) { return command.rfind("./luciole test", 0) == 0; });
  return commands;
}

/// A folder that looks like a checkout whose launcher has built the program.
void prepareCheckout(const TemporaryFolder& folder) {
  std::filesystem::create_symlink(LUCIOLE_BINARY, folder / "luciole");
  std::filesystem::create_symlink(kSource + "/scenes", folder / "scenes");
}

TEST(Readme, EveryCommandSucceeds) {
  LUCIOLE_NEEDS_PROGRAM("img2webp", "webp");
  const TemporaryFolder folder;
  prepareCheckout(folder);
  const std::vector<std::string> commands = commandsOf("README.md");
  EXPECT_GE(commands.size(), 10u);
  for (std::string command : commands) {
    // Minutes of measuring are not what a reader would find broken.
    if (command.rfind("./luciole bench", 0) == 0)
      command += " --size 160x90 --repeats 1 --only shading --only samples";
    if (command.rfind("./luciole scale scenes/", 0) == 0)
      command += " --size 64x36 --repeat 1 --check-pixels 16";
    command = std::regex_replace(command, std::regex("--frames 1-120"), "--frames 1-2");
    // Nor are pixels. A crop is of the size that it stands beside.
    command = std::regex_replace(command, std::regex("--samples 16"), "--samples 2");
    if (command.find("--crop") == std::string::npos) {
      command = std::regex_replace(command, std::regex("--size 960x540"), "--size 240x135");
      command = std::regex_replace(command, std::regex("--size 640x360"), "--size 320x180");
    }
    const Outcome outcome = runLine(folder, command);
    EXPECT_EQ(outcome.status, 0) << command << "\n" << outcome.err;
  }
}

struct Listing {
  std::vector<std::string> files;
  std::string text;
};

/// The blocks of kernel and host code, each with the files that the text between it and the block before
/// names.
std::vector<Listing> listingsOf(const std::string& readme) {
  std::istringstream lines(readText(kSource + "/" + readme));
  const std::regex path("`((?:host|kernels|tests)/[A-Za-z0-9_./]+)`");
  std::vector<Listing> listings;
  std::vector<std::string> files;
  bool in_block = false, in_code = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("```", 0) == 0) {
      in_block = !in_block;
      in_code = in_block && (line == "```c" || line == "```cpp");
      if (in_code) listings.push_back({std::exchange(files, {}), ""});
    } else if (in_code) {
      listings.back().text += line + "\n";
    } else if (!in_block) {
      for (auto i = std::sregex_iterator(line.begin(), line.end(), path); i != std::sregex_iterator(); ++i)
        if (std::filesystem::is_regular_file(kSource + "/" + (*i)[1].str())) files.push_back((*i)[1]);
    }
  }
  return listings;
}

TEST(Readme, ListingsAreWhatTheFilesSay) {
  const std::vector<Listing> listings = listingsOf("README.md");
  EXPECT_GE(listings.size(), 6u);
  for (const Listing& listing : listings)
    EXPECT_TRUE(std::any_of(listing.files.begin(), listing.files.end(),
                            [&](const std::string& file) {
                              return readText(kSource + "/" + file).find(listing.text) != std::string::npos;
                            }))
        << "no file that the text names has\n"
        << listing.text;
}

TEST(Readme, SceneFileExampleRenders) {
  const TemporaryFolder folder;
  for (const char* readme : {"README.md", "scenes/FORMATS.md"}) {
    const std::string text = readText(kSource + "/" + readme);
    const std::size_t start = text.find("```json\n");
    ASSERT_NE(start, std::string::npos) << readme;
    writeText(folder / "example.json", text.substr(start + 8, text.find("```", start + 8) - start - 8));
    const Outcome outcome = runLine(folder, "luciole render example.json --size 160x90 -o example.png");
    EXPECT_EQ(outcome.status, 0) << readme << ": " << outcome.err;
  }
}

TEST(Readme, PicturesAndFilesItNamesExist) {
  for (const char* readme : {"README.md", "scenes/README.md", "scenes/FORMATS.md"}) {
    const std::string text = readText(kSource + "/" + readme);
    const std::filesystem::path folder = std::filesystem::path(kSource + "/" + readme).parent_path();
    const std::regex link(R"(\]\(([^):#]+)\))"), path(R"(`((?:host|kernels|tests|scenes)/[A-Za-z0-9_./]+)`)");
    int found = 0;
    for (auto i = std::sregex_iterator(text.begin(), text.end(), link); i != std::sregex_iterator();
         ++i, ++found)
      EXPECT_TRUE(std::filesystem::exists(folder / (*i)[1].str())) << readme << " links to " << (*i)[1];
    for (auto i = std::sregex_iterator(text.begin(), text.end(), path); i != std::sregex_iterator();
         ++i, ++found)
      EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(kSource) / (*i)[1].str()))
          << readme << " names " << (*i)[1];
    EXPECT_GT(found, 0) << readme;
  }
}

}  // namespace
}  // namespace luciole::test
