#pragma once

#include <netinet/in.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "shared_files.hpp"

namespace luciole::test {

/// A headless Firefox that is told what to do by Marionette: texts "length:[0, id, command, parameters]" over
/// a socket (https://firefox-source-docs.mozilla.org/testing/marionette/Protocol.html). What it writes goes
/// into a temporary folder. Throws std::runtime_error.
class Firefox {
 public:
  Firefox() {
    const int port = freePort();
    std::ofstream(folder_ / "user.js")
        << "user_pref(\"marionette.port\", " << port << ");\n"
        << "user_pref(\"datareporting.policy.dataSubmissionEnabled\", false);\n"
        << "user_pref(\"app.update.enabled\", false);\n"
        << "user_pref(\"network.captive-portal-service.enabled\", false);\n"
        << "user_pref(\"network.connectivity-service.enabled\", false);\n";
    std::vector<std::string> words{"firefox-esr", "--headless", "--marionette",
                                   "--no-remote", "--profile",  folder_.path().string()};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    // Its sandbox needs rights that a container may not give.
    std::vector<std::string> variables{"HOME=" + folder_.path().string(), "TMPDIR=" + folder_.path().string(),
                                       "MOZ_DISABLE_CONTENT_SANDBOX=1", "MOZ_CRASHREPORTER_DISABLE=1"};
    for (char** variable = environ; *variable; ++variable)
      if (const std::string text = *variable; !text.starts_with("HOME=") && !text.starts_with("TMPDIR="))
        variables.push_back(text);
    std::vector<char*> environment;
    for (std::string& variable : variables) environment.push_back(variable.data());
    environment.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
      posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const int failure = posix_spawnp(&process_, words[0].c_str(), &actions, &attributes, arguments.data(),
                                     environment.data());
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (failure != 0) throw std::runtime_error("firefox doesn't start");
    try {
      connectTo(port);
      receive();  // who it is
      call("WebDriver:NewSession", {{"capabilities", nlohmann::json::object()}});
      call("WebDriver:SetTimeouts", {{"script", 120000}});
    } catch (...) {
      stop();
      throw;
    }
  }
  ~Firefox() { stop(); }
  Firefox(const Firefox&) = delete;
  Firefox& operator=(const Firefox&) = delete;

  void open(const std::string& address) { call("WebDriver:Navigate", {{"url", address}}); }

  /// The value of a JavaScript expression of the page's document, awaited where it is a promise. The names of
  /// the page's own scripts aren't seen.
  nlohmann::json evaluate(const std::string& expression) {
    const std::string script = "return (async () => { const value = await (" + expression +
                               "); return value === undefined ? null : value; })();";
    return call("WebDriver:ExecuteScript", {{"script", script}, {"args", nlohmann::json::array()}})["value"];
  }

  /// Drags from the middle of the element with this id, by so many CSS pixels.
  void drag(const std::string& id, int dx, int dy) {
    const nlohmann::json element =
        call("WebDriver:FindElement", {{"using", "css selector"}, {"value", "#" + id}})["value"];
    const auto move = [](const nlohmann::json& origin, int x, int y) {
      return nlohmann::json{
          {"type", "pointerMove"}, {"duration", 50}, {"origin", origin}, {"x", x}, {"y", y}};
    };
    call("WebDriver:PerformActions", {{"actions",
                                       {{{"type", "pointer"},
                                         {"id", "mouse"},
                                         {"parameters", {{"pointerType", "mouse"}}},
                                         {"actions",
                                          {move(element, 0, 0),
                                           {{"type", "pointerDown"}, {"button", 0}},
                                           move("pointer", dx / 2, dy / 2),
                                           move("pointer", dx - dx / 2, dy - dy / 2),
                                           {{"type", "pointerUp"}, {"button", 0}}}}}}}});
  }

 private:
  nlohmann::json call(const std::string& command, const nlohmann::json& parameters) {
    const std::string text = nlohmann::json{0, ++last_id_, command, parameters}.dump();
    const std::string message = std::to_string(text.size()) + ":" + text;
    for (std::size_t sent = 0; sent < message.size();) {
      const ssize_t count = send(socket_, message.data() + sent, message.size() - sent, MSG_NOSIGNAL);
      if (count <= 0) throw std::runtime_error(command + ": firefox doesn't listen");
      sent += std::size_t(count);
    }
    const nlohmann::json answer = receive();
    if (!answer[2].is_null()) throw std::runtime_error(command + ": " + answer[2].dump());
    return answer[3];
  }

  nlohmann::json receive() {
    std::string length;
    for (char c = 0; c != ':'; length += c)
      if (recv(socket_, &c, 1, 0) != 1) throw std::runtime_error("firefox has ended");
    std::string text(std::stoul(length), '\0');
    for (std::size_t got = 0; got < text.size();) {
      const ssize_t count = recv(socket_, text.data() + got, text.size() - got, 0);
      if (count <= 0) throw std::runtime_error("firefox has ended");
      got += std::size_t(count);
    }
    return nlohmann::json::parse(text);
  }

  static sockaddr_in loopback(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(std::uint16_t(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
  }

  static int freePort() {
    const int one = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address = loopback(0);
    socklen_t size = sizeof address;
    const bool is_bound = bind(one, reinterpret_cast<const sockaddr*>(&address), size) == 0 &&
                          getsockname(one, reinterpret_cast<sockaddr*>(&address), &size) == 0;
    close(one);
    if (!is_bound) throw std::runtime_error("no free port");
    return ntohs(address.sin_port);
  }

  /// It takes seconds to start, on a loaded machine a minute.
  void connectTo(int port) {
    for (int tries = 0; tries < 1200; ++tries) {
      socket_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
      const sockaddr_in address = loopback(port);
      if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
        const timeval limit{120, 0};
        setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
        return;
      }
      close(socket_);
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    throw std::runtime_error("firefox doesn't listen");
  }

  void stop() {
    if (process_ == 0) return;
    kill(-process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    close(socket_);
    for (int i = 0; i < 100 && kill(-process_, 0) == 0; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }

  TemporaryFolder folder_;
  pid_t process_ = 0;
  int socket_ = -1, last_id_ = 0;
};

}  // namespace luciole::test
