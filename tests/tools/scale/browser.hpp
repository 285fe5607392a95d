#pragma once

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "shared_files.hpp"

extern char** environ;

namespace luciole::test {

/// A headless Chromium with one page at a time, off the network, that is told what to do over a pipe (Chrome
/// DevTools Protocol: https://chromedevtools.github.io/devtools-protocol/). All that it writes goes into a
/// temporary folder. Throws std::runtime_error where the browser answers with an error, or not within
/// kLongestWait.
class Browser {
 public:
  Browser() {
    try {
      start();
      renewPage();
    } catch (...) {
      stop();
      throw;
    }
  }
  ~Browser() { stop(); }
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// Closes the page, and opens an empty one that shares nothing with it.
  void renewPage() {
    session_.clear();
    if (!context_.empty()) call("Target.disposeBrowserContext", {{"browserContextId", context_}});
    context_ = call("Target.createBrowserContext")["browserContextId"];
    const std::string target =
        call("Target.createTarget", {{"url", "about:blank"}, {"browserContextId", context_}})["targetId"];
    session_ = call("Target.attachToTarget", {{"targetId", target}, {"flatten", true}})["sessionId"];
    events_.clear();
    for (const char* domain : {"Page", "Runtime", "Log", "Network"}) call(std::string(domain) + ".enable");
    call("Page.setLifecycleEventsEnabled", {{"enabled", true}});
    call("Network.emulateNetworkConditions",
         {{"offline", true}, {"latency", 0}, {"downloadThroughput", 0}, {"uploadThroughput", 0}});
    resize(1280, 900);
    setColorScheme("light");
  }

  /// Whether it has left an answer or event out, so that no more is to be expected of it.
  bool isBroken() const { return broken_; }

  /// Sends a command and waits for its result; events that arrive meanwhile are kept.
  nlohmann::json call(const std::string& method,
                      const nlohmann::json& parameters = nlohmann::json::object()) {
    const auto deadline = Clock::now() + kLongestWait;
    nlohmann::json command{{"id", ++last_id_}, {"method", method}, {"params", parameters}};
    if (!session_.empty()) command["sessionId"] = session_;
    const std::string text = command.dump();
    if (write(commands_, text.c_str(), text.size() + 1) != static_cast<ssize_t>(text.size() + 1))
      throw std::runtime_error(method + ": the browser doesn't listen");
    for (;;) {
      const nlohmann::json message = nextMessage(method, deadline);
      if (!message.contains("id")) {
        keepEvent(message);
      } else if (message["id"] == last_id_) {
        if (message.contains("error")) throw std::runtime_error(method + ": " + message["error"].dump());
        return message["result"];
      }
    }
  }

  /// The value of a JavaScript expression on the page, awaited where it is a promise. What it does counts as
  /// done by a person.
  nlohmann::json evaluate(const std::string& expression) {
    const nlohmann::json outcome = call(
        "Runtime.evaluate",
        {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}, {"userGesture", true}});
    if (outcome.contains("exceptionDetails"))
      throw std::runtime_error(expression + ": " + outcome["exceptionDetails"].dump());
    return outcome["result"].value("value", nlohmann::json());
  }

  /// Opens a page whose text is `html` from a file, and waits until it has drawn itself.
  void open(const std::string& html) {
    const std::string path = folder_ / "page.html";
    std::ofstream(path, std::ios::binary) << html;
    navigate("file://" + path);
  }

  /// Opens the page of a server on this machine, which from then on is on the network: of this machine.
  void openAddress(const std::string& address) {
    call("Network.emulateNetworkConditions",
         {{"offline", false}, {"latency", 0}, {"downloadThroughput", -1}, {"uploadThroughput", -1}});
    navigate(address);
  }

  /// The text of the file `name` that the page lets be downloaded where `click` is evaluated on it.
  std::string download(const std::string& click, const std::string& name) {
    call("Browser.setDownloadBehavior", {{"behavior", "allow"},
                                         {"browserContextId", context_},
                                         {"downloadPath", folder_ / "downloads"},
                                         {"eventsEnabled", true}});
    evaluate(click);
    const nlohmann::json begun = waitForEvent("Browser.downloadWillBegin", [&](const nlohmann::json& event) {
      return event["suggestedFilename"] == name;
    });
    // The file has its name before it has its content.
    const nlohmann::json ended = waitForEvent("Browser.downloadProgress", [&](const nlohmann::json& event) {
      return event["guid"] == begun["guid"] && event["state"] != "inProgress";
    });
    if (ended["state"] != "completed") throw std::runtime_error("download " + name + ": " + ended.dump());
    return readText(folder_ / ("downloads/" + name));
  }

  /// Waits until the page has been laid out and painted after what was done to it.
  void settle() {
    evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))");
  }

  /// In CSS pixels.
  void resize(int width, int height) {
    call("Emulation.setDeviceMetricsOverride",
         {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
  }

  /// "light" or "dark", as the system would ask for.
  void setColorScheme(const std::string& scheme) {
    call("Emulation.setEmulatedMedia",
         {{"features", nlohmann::json::array({{{"name", "prefers-color-scheme"}, {"value", scheme}}})}});
  }

  /// Presses and releases a key, such as "Tab" (code 9).
  void press(const std::string& key, int code) {
    for (const char* type : {"rawKeyDown", "keyUp"})
      call("Input.dispatchKeyEvent",
           {{"type", type}, {"key", key}, {"code", key}, {"windowsVirtualKeyCode", code}});
  }

  /// Of the left mouse button: "mousePressed", "mouseMoved" (while pressed) or "mouseReleased".
  void mouse(const std::string& type, double x, double y) {
    call("Input.dispatchMouseEvent", {{"type", type},
                                      {"x", x},
                                      {"y", y},
                                      {"button", "left"},
                                      {"buttons", type == "mouseReleased" ? 0 : 1},
                                      {"clickCount", 1}});
  }

  /// What the page has put on the console, or the browser about it, and what it threw.
  std::vector<std::string> complaints() const {
    std::vector<std::string> found;
    for (const nlohmann::json& event : events_)
      if (event["method"] == "Runtime.consoleAPICalled" || event["method"] == "Runtime.exceptionThrown" ||
          event["method"] == "Log.entryAdded")
        found.push_back(event["params"].dump());
    return found;
  }

  /// Addresses that the page asked for.
  std::vector<std::string> requests() const {
    std::vector<std::string> found;
    for (const nlohmann::json& event : events_)
      if (event["method"] == "Network.requestWillBeSent") found.push_back(event["params"]["request"]["url"]);
    return found;
  }

 private:
  using Clock = std::chrono::steady_clock;
  /// For each answer and event: on a loaded machine a browser takes half a minute to start.
  static constexpr std::chrono::seconds kLongestWait{120};

  /// Waits until the page has drawn itself.
  void navigate(const std::string& address) {
    const nlohmann::json loader = call("Page.navigate", {{"url", address}})["loaderId"];
    waitForEvent("Page.lifecycleEvent", [&](const nlohmann::json& event) {
      return event["loaderId"] == loader && event["name"] == "load";
    });
    settle();
  }

  /// The profile is no use to anybody, so nothing is lost by ending without goodbye.
  void stop() {
    if (process_ == 0) return;
    kill(-process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    close(commands_);
    close(answers_);
    // Its other processes may take a moment to go (and stay as zombies where nobody reaps them).
    for (int i = 0; i < 100 && kill(-process_, 0) == 0; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }

  void start() {
    const auto [hears, commands] = makePipe();
    const auto [answers, speaks] = makePipe();
    commands_ = commands;
    answers_ = answers;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    // As --remote-debugging-pipe has it.
    posix_spawn_file_actions_adddup2(&actions, hears, 3);
    posix_spawn_file_actions_adddup2(&actions, speaks, 4);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    std::vector<std::string> words{"chromium",
                                   "--headless=new",
                                   "--remote-debugging-pipe",
                                   "--no-sandbox",
                                   "--disable-dev-shm-usage",
                                   "--disable-gpu",
                                   "--hide-scrollbars",
                                   "--no-first-run",
                                   "--disable-background-networking",
                                   "--disable-component-update",
                                   "--disable-extensions",
                                   "--disable-sync",
                                   "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
                                   "--user-data-dir=" + (folder_ / "profile")};
    std::vector<std::string> variables{"HOME=" + folder_.path().string(),
                                       "TMPDIR=" + folder_.path().string()};
    for (char** variable = environ; *variable; ++variable)
      if (const std::string text = *variable;
          !text.starts_with("HOME=") && !text.starts_with("TMPDIR=") && !text.starts_with("XDG_"))
        variables.push_back(text);
    const int failure = posix_spawnp(&process_, "chromium", &actions, &attributes, pointers(words).data(),
                                     pointers(variables).data());
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    close(hears);
    close(speaks);
    if (failure != 0) process_ = 0;
    if (failure != 0) throw std::runtime_error("chromium doesn't start");
  }

  /// Its ends to read from and to write to, above the numbers that the browser gives a meaning.
  static std::array<int, 2> makePipe() {
    std::array<int, 2> low, high;
    if (pipe2(low.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    for (int end : {0, 1}) {
      high[end] = fcntl(low[end], F_DUPFD_CLOEXEC, 10);
      close(low[end]);
    }
    return high;
  }

  static std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> found;
    for (std::string& text : texts) found.push_back(text.data());
    found.push_back(nullptr);
    return found;
  }

  /// But for what a page before has still to tell.
  void keepEvent(const nlohmann::json& event) {
    if (event.value("sessionId", session_) == session_) events_.push_back(event);
  }

  /// The parameters of the first event of this name that fits, among those that came already or the next.
  template <typename Fits>
  nlohmann::json waitForEvent(const std::string& name, const Fits& fits) {
    const auto deadline = Clock::now() + kLongestWait;
    for (std::size_t i = 0;; ++i) {
      while (i == events_.size())
        if (const nlohmann::json message = nextMessage(name, deadline); !message.contains("id"))
          keepEvent(message);
      if (events_[i]["method"] == name && fits(events_[i]["params"])) return events_[i]["params"];
    }
  }

  nlohmann::json nextMessage(const std::string& waiting_for, Clock::time_point deadline) {
    broken_ = true;
    for (;;) {
      if (const std::size_t end = received_.find('\0'); end != std::string::npos) {
        const std::string message = received_.substr(0, end);
        received_.erase(0, end + 1);
        broken_ = false;
        return nlohmann::json::parse(message);
      }
      pollfd readable{answers_, POLLIN, 0};
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
      if (left.count() <= 0 || poll(&readable, 1, static_cast<int>(left.count())) != 1)
        throw std::runtime_error(waiting_for + ": no answer from the browser");
      std::array<char, 65536> part;
      const ssize_t count = read(answers_, part.data(), part.size());
      if (count <= 0) throw std::runtime_error(waiting_for + ": the browser has ended");
      received_.append(part.data(), count);
    }
  }

  TemporaryFolder folder_;
  pid_t process_ = 0;
  int commands_ = -1, answers_ = -1;
  int last_id_ = 0;
  bool broken_ = false;
  std::string context_, session_, received_;
  std::vector<nlohmann::json> events_;
};

/// A browser with an empty page. It takes seconds to start, so all tests of a process share one.
inline Browser& browserWithEmptyPage() {
  static std::unique_ptr<Browser> shared;
  if (shared && !shared->isBroken()) {
    shared->renewPage();
  } else {
    shared.reset();
    shared = std::make_unique<Browser>();
  }
  return *shared;
}

}  // namespace luciole::test
