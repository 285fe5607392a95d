// What the READMEs tell a reader to type works as they say it.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

#include "tools/cli/run_program.hpp"

namespace luciole::test {
namespace {

namespace fs = std::filesystem;

const std::string kSource = LUCIOLE_SOURCE_DIR;

/// Every text for readers, but for the list of changes.
constexpr const char* kReadmes[] = {"README.md",
                                    "host/README.md",
                                    "host/python/README.md",
                                    "host/tools/bench/README.md",
                                    "host/tools/cli/README.md",
                                    "host/tools/scale/README.md",
                                    "host/tools/view/README.md",
                                    "kernels/README.md",
                                    "kernels/examples/README.md",
                                    "scenes/FORMATS.md",
                                    "scenes/README.md",
                                    "scenes/lesson/README.md",
                                    "scenes/lesson/shaders.md",
                                    "tests/README.md"};

/// What no test types, by how it begins.
struct NotRun {
  const char* begins;
  const char* reason;
};
constexpr NotRun kNotRun[] = {
    {"./luciole test", "would run this test"},
    {"./luciole view ", "serves until it is ended: view_test.cpp types it"},
    {"./luciole bench --only \"shadow errors\"", "takes minutes, whatever the size"},
    {"./luciole bench --only \"many lights\"", "lights a million, whatever the size"},
    {"./luciole bench --only \"light error\"", "lights a million, whatever the size"},
    {"./luciole bench --only \"shadowed lights\"", "takes minutes"},
    {"./luciole bench --only picture", "takes minutes, whatever the size"},
    {"./luciole bench`", "takes minutes"},
    {"scenes/make_pictures.sh", "takes minutes, and writes into the sources"},
    {"build/tests/", "is not there unless all is built, and takes minutes"},
    {"ninja ", "builds"},
    {"cmake ", "builds all anew"},
    {"python3 -m venv ", "takes PyPI; tests/python/python_test.sh does so where it is reached"},
    {"venv/bin/", "takes PyPI; tests/python/python_test.sh does so where it is reached"},
    {"python -m build", "takes PyPI and minutes; tests/python/python_test.sh says it"},
    {"auditwheel ", "takes PyPI and a wheel"},
    {"tests/bare_root.sh", "takes root, a network and minutes"},
    {"tests/mutate_kernels.py", "takes hours"},
    {"tests/tidy.sh", "takes clang-tidy 14 and minutes"},
    {"tests/tools/cli/other_programs_test.sh",
     "takes PyPI, a gigabyte and minutes; ctest runs it where it can"},
    {"tests/tools/devices/intel_opencl_test.sh",
     "takes PyPI, a gigabyte and minutes; ctest runs it where it can"},
    {"tests/tools/devices/make_hashes.sh", "writes into the sources"},
    {"sbatch ", "takes Slurm: tests/tools/cli/slurm_test.sh runs such an array"},
    {"scontrol ", "takes Slurm: tests/tools/cli/slurm_test.sh says it"},
    {"oiiotool ", "reads what an array of 50 tasks made"},
    {"ffmpeg ", "reads what an array of 50 tasks made"},
    {"python3 tests/kernels/instruction_counts.py", "takes a build folder, and shows figures to look at"},
    {"oclgrind ", "is not on every system; tests/kernels/checked_test.cpp runs it where it is"},
    {"POCL_", "takes a build folder, and leaves machine code to look at"},
    {"objdump ", "shows machine code to look at"},
};

const NotRun* whyNotRun(const std::string& command) {
  for (const NotRun& one : kNotRun)
    if ((command + "`").rfind(one.begins, 0) == 0) return &one;
  return nullptr;
}

/// A part of a README below a heading of its own, with the commands it shows. They may need each other.
struct Section {
  std::string name{};  ///< of the file and the heading, in letters, digits and _
  std::vector<std::string> commands{};
};
std::ostream& operator<<(std::ostream& out, const Section& section) { return out << section.name; }

std::string plainName(const std::string& text) {
  std::string name;
  bool start = true;
  for (const char c : text) {
    const bool letter = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (letter) name += start ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    start = !letter;
  }
  return name;
}

/// Commands are the lines of ```sh blocks, and whatever begins like a command in the text and in other
/// blocks.
std::vector<Section> sectionsOf(const std::string& readme) {
  std::istringstream lines(readText(kSource + "/" + readme));
  const std::string file = plainName(readme.substr(0, readme.size() - 3));
  const std::regex quoted("`([^`]+)`");
  const std::regex command(
      R"(^(\./luciole|sbatch|scontrol|cmake|ctest|ninja|python3|oiiotool|ffmpeg|objdump|apt|apt-get|sudo|POCL_\w+=\S+|(build|tests|scenes)/\S+) \S.*)");
  std::vector<Section> sections{{file, {}}};
  bool in_block = false, in_shell = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("```", 0) == 0) {
      in_block = !in_block;
      in_shell = in_block && line == "```sh";
      continue;
    }
    std::vector<std::string>& commands = sections.back().commands;
    const std::string text = line.substr(std::min(line.find_first_not_of(' '), line.size()));
    if (in_shell) {
      if (!text.empty() && text[0] != '#') commands.push_back(text);
    } else if (std::regex_match(text, command)) {
      commands.push_back(text);
    } else if (!in_block && line.rfind("##", 0) == 0) {
      sections.push_back({file + "_" + plainName(line), {}});
    } else if (!in_block) {
      for (auto i = std::sregex_iterator(line.begin(), line.end(), quoted); i != std::sregex_iterator();
           ++i) {
        const std::string span = (*i)[1];
        if (std::regex_match(span, command)) commands.push_back(span);
      }
    }
  }
  return sections;
}

std::vector<Section> allSections() {
  std::vector<Section> all;
  for (const char* readme : kReadmes)
    for (Section& section : sectionsOf(readme)) all.push_back(std::move(section));
  return all;
}

/// Those with something to run.
std::vector<Section> sectionsToRun() {
  std::vector<Section> sections = allSections();
  for (Section& section : sections)
    std::erase_if(section.commands, [](const std::string& command) { return whyNotRun(command) != nullptr; });
  std::erase_if(sections, [](const Section& section) { return section.commands.empty(); });
  return sections;
}

/// Pixels, lights and minutes of measuring are not what a reader would find broken. A probe lies in its
/// picture, and a crop is as much smaller as its picture.
std::string atLittleCost(std::string command) {
  const auto has = [&](const char* words) { return command.find(words) != std::string::npos; };
  const auto replace = [&](const char* words, const char* others) {
    command = std::regex_replace(command, std::regex(words), others);
  };
  if (command.rfind("./luciole bench", 0) == 0) {
    command += " --size 64x36 --repeats 1";
    if (!has("--only")) command += " --only shading --only samples";
  }
  if (command.rfind("./luciole scale scenes/", 0) == 0)
    command += " --size 64x36 --repeat 1 --check-pixels 16";
  if (has(" scenes/") && (has(" render ") || has(" shadow-map ")) && !has("--size"))
    command += " --size 64x48";
  replace("1000,2000,\\.\\.\\.,1024000", "1000,2000");
  replace("1000,10000,100000", "1000");
  replace("1,10,\\.\\.\\.,10+\\b", "1,10,...,100");
  replace("--count 500\\b", "--count 20");
  replace("--frames 1-120\\b", "--frames 1-2");
  replace("--samples 16\\b", "--samples 2");
  if (has("--crop")) {
    replace("--crop (\\d+)0,(\\d+)0,(\\d+)0,(\\d+)0\\b", "--crop $1,$2,$3,$4");
    replace("--size 960x540", "--size 96x54");
  } else {
    replace("--size \\d{3,4}x\\d{3,4}", has("--probe") ? "--size 160x90" : "--size 64x36");
    replace("--size 640\\b(?!x)", "--size 64");
  }
  return command;
}

/// A folder that looks like a checkout whose launcher has built the program.
void prepareCheckout(const TemporaryFolder& folder) {
  fs::create_symlink(LUCIOLE_BINARY, folder / "luciole");
  for (const char* room : {"scenes", "kernels"}) fs::create_symlink(kSource + "/" + room, folder / room);
}

class SectionOfReadme : public testing::TestWithParam<Section> {};

TEST_P(SectionOfReadme, CommandsSucceed) {
  const TemporaryFolder folder;
  prepareCheckout(folder);
  for (const std::string& command : GetParam().commands) {
    if (command.find(".mp4") != std::string::npos) LUCIOLE_NEEDS_PROGRAM("ffmpeg", "ffmpeg");
    const Outcome outcome = runLine(folder, atLittleCost(command));
    EXPECT_EQ(outcome.status, 0) << command << "\n" << outcome.err;
  }
}

INSTANTIATE_TEST_SUITE_P(Readme, SectionOfReadme, testing::ValuesIn(sectionsToRun()),
                         [](const testing::TestParamInfo<Section>& one) { return one.param.name; });

TEST(Readme, EveryTextForReadersIsLookedAt) {
  std::set<std::string> there;
  for (const char* folder : {"host", "kernels", "scenes", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(kSource + "/" + folder))
      if (entry.path().extension() == ".md") there.insert(fs::relative(entry.path(), kSource).string());
  there.insert("README.md");
  EXPECT_EQ(std::set<std::string>(std::begin(kReadmes), std::end(kReadmes)), there);
}

TEST(Readme, EveryCommandThatIsNotRunIsShownSomewhere) {
  std::set<const NotRun*> used;
  for (const Section& section : allSections())
    for (const std::string& command : section.commands) used.insert(whyNotRun(command));
  for (const NotRun& one : kNotRun) EXPECT_TRUE(used.count(&one)) << one.begins << ": " << one.reason;
}

// One screen sells; a manual doesn't.
TEST(Readme, FirstHasAtMost150Lines) {
  const std::string text = readText(kSource + "/README.md");
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 150);
}

struct Listing {
  std::vector<std::string> files{};  ///< that the text names between this block and the one before
  std::string language{}, text{};
};

/// The blocks of code and of scenes.
std::vector<Listing> listingsOf(const std::string& readme) {
  std::istringstream lines(readText(kSource + "/" + readme));
  const std::regex path("`((?:host|kernels|tests|scenes)/[A-Za-z0-9_./]+)`");
  std::vector<Listing> listings;
  std::vector<std::string> files;
  bool in_block = false, in_code = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("```", 0) == 0) {
      in_block = !in_block;
      in_code = in_block && (line == "```c" || line == "```cpp" || line == "```json");
      if (in_code) listings.push_back({std::exchange(files, {}), line.substr(3), ""});
    } else if (in_code) {
      listings.back().text += line + "\n";
    } else if (!in_block) {
      for (auto i = std::sregex_iterator(line.begin(), line.end(), path); i != std::sregex_iterator(); ++i)
        if (fs::is_regular_file(kSource + "/" + (*i)[1].str())) files.push_back((*i)[1]);
    }
  }
  return listings;
}

bool fileHas(const std::string& file, const std::string& text) {
  return readText(kSource + "/" + file).find(text) != std::string::npos;
}

TEST(Readme, ListingsAreWhatTheFilesSay) {
  int found = 0;
  for (const char* readme : kReadmes)
    for (const Listing& listing : listingsOf(readme)) {
      if (listing.files.empty() && listing.language == "json") continue;  // a scene of its own, see below
      ++found;
      EXPECT_TRUE(std::any_of(listing.files.begin(), listing.files.end(),
                              [&](const std::string& file) { return fileHas(file, listing.text); }))
          << readme << ": no file that the text names has\n"
          << listing.text;
    }
  EXPECT_GE(found, 6);
}

TEST(Readme, SceneFileExampleRenders) {
  const std::vector<Listing> listings = listingsOf("scenes/FORMATS.md");
  ASSERT_FALSE(listings.empty());
  const TemporaryFolder folder;
  writeText(folder / "example.json", listings[0].text);
  const Outcome outcome = runLine(folder, "luciole render example.json --size 160x90 -o example.png");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
}

/// The links to a heading, as GitHub makes them.
std::set<std::string> anchorsOf(const fs::path& file) {
  std::istringstream lines(readText(file.string()));
  std::set<std::string> anchors;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("#", 0) != 0) continue;
    std::string anchor;
    for (const char c : line.substr(std::min(line.find(' ') + 1, line.size())))
      if (c == ' ')
        anchor += '-';
      else if (c == '-' || c == '_' || std::isalnum(static_cast<unsigned char>(c)))
        anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    anchors.insert(anchor);
  }
  return anchors;
}

TEST(Readme, LinksLeadSomewhereAndFilesItNamesExist) {
  const std::regex link(R"(\]\(([^):#\s]*)(?:#([^)\s]*))?\))");
  const std::regex path(R"(`((?:host|kernels|tests|scenes)/[A-Za-z0-9_./]+)`)");
  for (const char* readme : kReadmes) {
    const fs::path file = fs::path(kSource) / readme;
    const std::string text = readText(file.string());
    for (auto i = std::sregex_iterator(text.begin(), text.end(), link); i != std::sregex_iterator(); ++i) {
      const fs::path target = (*i)[1].length() ? file.parent_path() / (*i)[1].str() : file;
      EXPECT_TRUE(fs::exists(target)) << readme << " links to " << (*i)[1];
      if ((*i)[2].matched && fs::exists(target)) {
        EXPECT_TRUE(anchorsOf(target).count((*i)[2])) << readme << " links to " << (*i)[0];
      }
    }
    for (auto i = std::sregex_iterator(text.begin(), text.end(), path); i != std::sregex_iterator(); ++i)
      EXPECT_TRUE(fs::exists(fs::path(kSource) / (*i)[1].str())) << readme << " names " << (*i)[1];
  }
}

/// The pictures that a text shows, by their path in the sources.
std::set<std::string> picturesIn(const std::string& readme) {
  const std::string text = readText(kSource + "/" + readme);
  const std::regex shown(R"(!\[[^\]]*\]\(([^)\s]+)\))");
  std::set<std::string> pictures;
  for (auto i = std::sregex_iterator(text.begin(), text.end(), shown); i != std::sregex_iterator(); ++i)
    pictures.insert((fs::path(readme).parent_path() / (*i)[1].str()).lexically_normal().string());
  return pictures;
}

/// The commands of scenes/make_pictures.sh as a reader would type them, by the picture they make.
std::map<std::string, std::string> commandsOfPictures() {
  std::istringstream lines(readText(kSource + "/scenes/make_pictures.sh"));
  std::map<std::string, std::string> commands;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("picture ", 0) != 0) continue;
    const std::size_t end = line.find(' ', 8);
    const std::string file = line.substr(8, end - 8);
    commands[file] = "./luciole" + line.substr(end) + " " + fs::path(file).filename().string();
  }
  return commands;
}

TEST(Readme, OneCommandMakesEveryPictureThatIsShownAndNoOther) {
  std::set<std::string> shown, made, there;
  for (const char* readme : kReadmes) shown.merge(picturesIn(readme));
  for (const auto& [file, command] : commandsOfPictures()) made.insert(file);
  for (const auto& entry : fs::recursive_directory_iterator(kSource + "/scenes"))
    for (const char* extension : {".png", ".jpg", ".svg", ".webp"})
      if (entry.path().extension() == extension) there.insert(fs::relative(entry.path(), kSource).string());
  EXPECT_EQ(made, shown);
  EXPECT_EQ(made, there);
}

TEST(Readme, EveryPictureStandsBesideTheCommandThatMakesItAnew) {
  for (const auto& [file, command] : commandsOfPictures())
    EXPECT_TRUE(std::any_of(std::begin(kReadmes), std::end(kReadmes),
                            [&, picture = file, line = command](const char* readme) {
                              return picturesIn(readme).count(picture) && fileHas(readme, line);
                            }))
        << "no README shows " << file << " and\n"
        << command;
}

}  // namespace
}  // namespace luciole::test
