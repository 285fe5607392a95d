// luciole view as a person uses it: the program, its server and its page in a browser.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "base/sha256.hpp"
#include "shared_files.hpp"
#include "tools/cli/firefox.hpp"
#include "tools/cli/program_test.hpp"
#include "tools/scale/browser.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

/// luciole view, at work until this goes.
class ServedView {
 public:
  /// variables: "NAME=value" of its environment, beside this process's.
  explicit ServedView(std::vector<std::string> words, std::vector<std::string> variables = {}) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    words.insert(words.begin(), {LUCIOLE_BINARY, "view", "--quiet"});
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    std::vector<char*> environment;
    for (std::string& variable : variables) environment.push_back(variable.data());
    for (char** variable = environ; *variable; ++variable) environment.push_back(*variable);
    environment.push_back(nullptr);
    const int failure =
        posix_spawn(&process_, LUCIOLE_BINARY, &actions, nullptr, arguments.data(), environment.data());
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    if (failure != 0) throw std::runtime_error("luciole doesn't start");
    for (char c = 0; read(ends[0], &c, 1) == 1 && c != '\n';) address_ += c;
    close(ends[0]);
  }
  ~ServedView() { stop(); }
  ServedView(const ServedView&) = delete;
  ServedView& operator=(const ServedView&) = delete;

  void stop() {
    if (process_ == 0) return;
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
    process_ = 0;
  }
  const std::string& address() const { return address_; }

 private:
  pid_t process_ = 0;
  std::string address_;
};

/// Evaluates an expression until it is true.
template <class Browser>
void await(Browser& browser, const std::string& expression) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(90);
  while (browser.evaluate("Boolean(" + expression + ")") != true) {
    if (std::chrono::steady_clock::now() > deadline)
      throw std::runtime_error(expression + " never came true; messages: " +
                               browser.evaluate("document.getElementById('messages').textContent").dump());
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

/// All samples of the full picture are there.
const std::string kAtRest =
    "document.getElementById('frame').dataset.level === '3' && document.getElementById('picture').width > 16";
/// The same, after the camera has moved.
const std::string kMoved = "document.getElementById('frame').dataset.camera !== 'null' && " + kAtRest;

class ViewPage : public ProgramTest {
 protected:
  void writeScene(const std::string& text) const {
    std::ofstream(folder / "scene.json", std::ios::binary | std::ios::trunc) << text;
  }

  /// The SHA-256 of a picture's codes as a canvas has them, of a file that render wrote.
  std::string codesOf(const std::string& ppm) {
    const std::string bytes = readText(folder / ppm);
    std::size_t at = 0;
    for (int i = 0; i < 3; ++i) at = bytes.find('\n', at) + 1;  // P6, the size, 255
    std::string codes;
    for (std::size_t i = at; i + 2 < bytes.size(); i += 3) codes += bytes.substr(i, 3) + '\xff';
    Sha256 hash;
    hash.add(codes.data(), codes.size());
    return hash.hex();
  }

  /// The same of the page's canvas.
  template <class Browser>
  std::string codesShown(Browser& browser) {
    return browser
        .evaluate(
            "(async () => { const shown = document.getElementById('picture'), copy = new "
            "OffscreenCanvas(shown.width, "
            "shown.height), context = copy.getContext('2d', {willReadFrequently: true}); "
            "context.drawImage(shown, 0, 0); "
            "const data = context.getImageData(0, 0, copy.width, copy.height).data; const hash = await "
            "crypto.subtle.digest('SHA-256', data); return [...new Uint8Array(hash)].map(byte => "
            "byte.toString(16).padStart(2, '0')).join(''); })()")
        .template get<std::string>();
  }

  /// Renders what the page says that it shows.
  template <class Browser>
  std::string rendered(Browser& browser, const std::string& options = "") {
    const std::string camera = browser.evaluate("document.getElementById('frame').dataset.camera");
    const std::string size =
        browser.evaluate("document.getElementById('frame').dataset.size.replace(',', 'x')");
    const std::string set = camera == "null" ? "" : " --set 'camera=" + camera + "'";
    succeed("luciole render scene.json --quiet --size " + size + set + " " + options + " -o shown.ppm");
    return codesOf("shown.ppm");
  }
};

constexpr const char* kViewScene = R"({
  "camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0], "fov_y": 50}, "size": [160, 90],
  "background": [0.2, 0.3, 0.4], "ambient": [0.1, 0.1, 0.1],
  "materials": {"stone": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}},
  "objects": [{"primitive": "plane", "scale": 10, "material": "stone"},
              {"primitive": "sphere", "translate": [0, 1, 0], "material": "stone", "name": "ball"}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "color": [0.5, 0.5, 0.5], "shadow": true, "name": "sun"},
             {"type": "point", "position": [1, 2, 2], "range": 4, "color": [1, 0.5, 0.2], "name": "lamp"}]
})";

TEST_F(ViewPage, TurnsAndShowsTheBitsOfRender) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  writeScene(kViewScene);
  const ServedView served({folder / "scene.json", "-o", folder.path().string()});
  Browser& browser = browserWithEmptyPage();
  browser.resize(900, 600);
  browser.openAddress(served.address());
  await(browser, kAtRest);
  const std::string first = codesShown(browser);
  EXPECT_EQ(first, rendered(browser));
  // The pointer turns it.
  const Json box = browser.evaluate(
      "(() => { const box = document.getElementById('frame').getBoundingClientRect(); return [box.x, box.y, "
      "box.width, "
      "box.height]; })()");
  const double x = box[0].get<double>() + box[2].get<double>() / 2,
               y = box[1].get<double>() + box[3].get<double>() / 2;
  browser.mouse("mousePressed", x, y);
  for (int i = 1; i <= 5; ++i) browser.mouse("mouseMoved", x + 12 * i, y + 4 * i);
  browser.mouse("mouseReleased", x + 60, y + 20);
  await(browser, kMoved);
  const std::string turned = codesShown(browser);
  EXPECT_NE(turned, first);
  EXPECT_EQ(turned, rendered(browser));
  // So do keys.
  browser.press("ArrowUp", 38);
  await(browser, kAtRest);
  EXPECT_NE(codesShown(browser), turned);
  EXPECT_EQ(codesShown(browser), rendered(browser));
  // What is set is what render has by its options, and samples come at the end.
  browser.evaluate("setOption('samples', '4'); setOption('shading', 'flat')");
  await(browser, kAtRest);
  EXPECT_EQ(codesShown(browser), rendered(browser, "--samples 4 --shading flat"));
  EXPECT_TRUE(browser.complaints().empty()) << browser.complaints().front();
  for (const std::string& request : browser.requests())
    EXPECT_TRUE(request.starts_with(served.address()) || request.starts_with("blob:") ||
                request.starts_with("data:"))
        << request;
}

TEST_F(ViewPage, AnEditedShaderChangesThePictureAndABrokenOneKeepsTheLastAndSaysWhere) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  writeScene(kViewScene);
  const ServedView served({folder / "scene.json", "-o", folder.path().string()});
  Browser& browser = browserWithEmptyPage();
  browser.openAddress(served.address());
  await(browser, kAtRest);
  const std::string plain = codesShown(browser);
  const auto type = [&](const std::string& text) {
    browser.evaluate("(() => { const area = document.getElementById('text'); area.value = " +
                     Json(text).dump() + "; area.dispatchEvent(new Event('input', {bubbles: true})); })()");
  };
  const std::string good =
      "INLINE Reflection reflect_light(const Surface *s, vec3L to_light, floatL n_dot_l) {\n"
      "  Reflection r;\n  r.diffuse = n_dot_l * n_dot_l;\n  r.specular = (floatL)(0.0f);\n  return r;\n}\n";
  type(good);
  await(browser, "view.shaders.model && " + kAtRest);
  const std::string edited = codesShown(browser);
  EXPECT_NE(edited, plain);
  std::ofstream(folder / "mine.clh") << good;
  EXPECT_EQ(edited, rendered(browser, "--model mine.clh"));
  type(
      "INLINE Reflection reflect_light(const Surface *s, vec3L to_light, floatL n_dot_l) {\n  nothing "
      "here\n}\n");
  await(browser, "document.getElementById('shader_fault').textContent");
  EXPECT_THAT(browser.evaluate("document.getElementById('shader_fault').textContent").get<std::string>(),
              HasSubstr("model.clh:2:"));
  await(browser, kAtRest);
  EXPECT_EQ(codesShown(browser), edited);
}

TEST_F(ViewPage, ReadsTheSceneAgainWhenItChangesAndTellsWhatIsWrongWithIt) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  writeScene(kViewScene);
  ServedView served({folder / "scene.json", "-o", folder.path().string()});
  Browser& browser = browserWithEmptyPage();
  browser.openAddress(served.address());
  await(browser, kAtRest);
  const std::string plain = codesShown(browser);
  writeScene("{\"lights\": 1}");
  await(browser, "document.getElementById('messages').textContent.includes('lights')");
  await(browser, kAtRest);
  EXPECT_EQ(codesShown(browser), plain);
  Json other = Json::parse(kViewScene);
  other["background"] = {1, 0, 0};
  writeScene(other.dump());
  await(browser, "state.fault === null && state.background[0] === 1");
  await(browser, kAtRest);
  EXPECT_EQ(codesShown(browser), rendered(browser));
  served.stop();
  await(browser, "document.getElementById('messages').textContent.includes('gone')");
}

TEST_F(ViewPage, TellsOfADeviceThatFailsAndKeepsTheLastPicture) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  writeScene(kViewScene);
  succeed("cc -shared -fPIC -o failing.so '" LUCIOLE_SOURCE_DIR "/tests/tools/cli/failing_device.c' -ldl");
  // The first full picture takes a dozen launches and compiling as many.
  const ServedView served({folder / "scene.json", "-o", folder.path().string()},
                          {"LD_PRELOAD=" + (folder / "failing.so"), "FAIL_AT=150"});
  Browser& browser = browserWithEmptyPage();
  browser.openAddress(served.address());
  await(browser, kAtRest);
  const std::string told = "document.getElementById('messages').textContent";
  for (int i = 0; i < 200 && browser.evaluate("!" + told) == true; ++i) {
    browser.evaluate("gesture('orbit', 0.05, 0)");
    await(browser, kAtRest + " || " + told);
  }
  EXPECT_THAT(browser.evaluate(told).get<std::string>(), HasSubstr("CL_DEVICE_NOT_AVAILABLE"));
  EXPECT_EQ(browser.evaluate("document.getElementById('picture').width > 16"), true);
  // The server goes on answering.
  EXPECT_EQ(browser.evaluate("askJson('state').then(state => state.light_count)"), 2);
}

TEST_F(ViewPage, SavesASceneThatTheCommandRendersToThePictureOfThePage) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  writeScene(kViewScene);
  const ServedView served({folder / "scene.json", "-o", folder.path().string()});
  Browser& browser = browserWithEmptyPage();
  browser.openAddress(served.address());
  await(browser, kAtRest);
  browser.evaluate(
      "setChange('lights[1].color', '#00ff80'); setChange('lights[1].intensity', 3); gesture('orbit', 0.2, "
      "0.1)");
  await(browser, kMoved);
  browser.evaluate("document.getElementById('save').click()");
  await(browser, "document.getElementById('saved').textContent.includes('scene-view-1.png')");
  const std::string command =
      browser.evaluate("document.getElementById('saved_command').firstElementChild.textContent");
  succeed(command.substr(0, command.rfind(" -o ")) + " --quiet -o again.png");
  EXPECT_EQ(readText(folder / "again.png").size() > 1000, true);
  expectSamePicture("scene-view-1.png", "again.png");
}

TEST_F(ViewPage, ShowsAnExrsLayers) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  writeScene(kViewScene);
  succeed("luciole render scene.json --aov normal,depth --light-groups --quiet -o a.exr");
  succeed("luciole render scene.json --shadows off --quiet -o b.exr");
  const ServedView served({folder / "a.exr", folder / "b.exr"});
  Browser& browser = browserWithEmptyPage();
  browser.openAddress(served.address());
  await(browser, "state && state.kind === 'files'");
  await(browser, "document.getElementById('picture').width > 16");
  EXPECT_THAT(browser.evaluate("document.body.innerText").get<std::string>(),
              HasSubstr("light_groups.default"));
  EXPECT_TRUE(browser.complaints().empty()) << browser.complaints().front();
}

TEST_F(ViewPage, WorksInFirefox) {
  LUCIOLE_NEEDS_PROGRAM("firefox-esr", "firefox-esr");
  writeScene(kViewScene);
  const ServedView served({folder / "scene.json", "-o", folder.path().string()});
  Firefox browser;
  browser.open(served.address());
  await(browser, kAtRest);
  EXPECT_EQ(codesShown(browser), rendered(browser));
  browser.drag("frame", 60, 20);
  await(browser, kMoved);
  EXPECT_EQ(codesShown(browser), rendered(browser));
}

TEST_F(ViewPage, WhatCannotBeShownIsRefusedInOneLine) {
  writeScene(kViewScene);
  refuse("luciole view missing.json", 2, "missing.json");
  refuse("luciole view scene.json -o nowhere", 2, "no such folder");
  refuse("luciole view scene.json other.exr", 2, "other.exr");
  refuse("luciole view scene.json --host 203.0.113.1 --quiet", 2, "--host");
  refuse("OCL_ICD_VENDORS=/nonexistent luciole view scene.json", 3, "no OpenCL device");
  refuse("luciole view scene.json --surface a.clh --surface b.clh", 2, "--surface");
}

}  // namespace
}  // namespace luciole::test
