#include "tools/view/server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/random.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::StartsWith;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr long kMostGrowth = 1 << 20;  ///< KiB: they keep what is freed for a while
#else
constexpr long kMostGrowth = 32 << 10;
#endif

constexpr std::size_t kLargeAnswer = std::size_t(8) << 20;

/// A number of /proc/self/status: VmRSS in KiB, Threads.
long ownStatus(const std::string& name) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(name + ":")) return std::stol(line.substr(name.size() + 1));
  return -1;
}

/// A connection to a port of this machine. Without an answer for 30 s it gives up.
class Client {
 public:
  explicit Client(int port) : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const timeval limit{30, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(std::uint16_t(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~Client() { close(socket_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// False where the connection ended.
  bool send(const std::string& bytes) const {
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t count = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (count <= 0) return false;
      sent += std::size_t(count);
    }
    return true;
  }
  void sendNoMore() const { shutdown(socket_, SHUT_WR); }

  /// Until the connection's end, or so many bytes.
  std::string receive(std::size_t most = std::string::npos) const {
    std::string bytes;
    std::vector<char> part(65536);
    while (bytes.size() < most) {
      const ssize_t count = recv(socket_, part.data(), std::min(part.size(), most - bytes.size()), 0);
      if (count <= 0) break;
      bytes.append(part.data(), std::size_t(count));
    }
    return bytes;
  }

  /// Goes away as a process does that is killed: what it hasn't read is lost.
  void abort() const {
    const linger none{1, 0};
    setsockopt(socket_, SOL_SOCKET, SO_LINGER, &none, sizeof none);
  }

 private:
  int socket_;
};

/// A server with a page, an echo, a large answer, one that waits, and ones that fail.
class ViewServer : public testing::Test {
 protected:
  ViewServer() {
    // Answers get pages of their own, which go back when they are freed. Without this line malloc raises the
    // limit after the first, and each of its arenas, up to 8 a core, may keep twice the largest answer.
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
    const auto large = [] { return Answer{200, "image/png", std::string(kLargeAnswer, 'x'), ""}; };
    Handlers handlers;
    handlers.get = {{"/",
                     [] {
                       return Answer{200, "text/html", "page", "abc"};
                     }},
                    {"/state",
                     [] {
                       return Answer{200, "application/json", "{}", ""};
                     }},
                    {"/large", large}};
    handlers.post = {{"/echo",
                      [](const std::string& body) {
                        return Answer{200, "application/json", body, ""};
                      }},
                     {"/wait", [this](const std::string&) { return waitAtGate(); }},
                     {"/input", [](const std::string&) -> Answer { throw InputError("bad \xff text"); }},
                     {"/machine", [](const std::string&) -> Answer { throw MachineError("no memory"); }}};
    server.emplace(ServerSettings{}, handlers);
    const std::string& address = server->address();
    EXPECT_THAT(address, StartsWith("http://127.0.0.1:"));
    port = std::stoi(address.substr(17));
    base = address.substr(address.find('/', 17));
    base.pop_back();
    thread = std::thread([this] { server->run(); });
    threads = ownStatus("Threads");
  }
  ~ViewServer() override {
    opened.set_value();
    server->stop();
    thread.join();
  }

  Answer waitAtGate() {
    ++waiting;
    gate.wait();
    return {};
  }

  std::string head(const std::string& method, const std::string& path, const std::string& more = "") const {
    return method + " " + path + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n" + more;
  }
  std::string get(const std::string& path, const std::string& more = "") const {
    return head("GET", base + path, more) + "Connection: close\r\n\r\n";
  }
  std::string post(const std::string& path, const std::string& body) const {
    return head("POST", base + path) +
           "Connection: close\r\nContent-Type: application/json\r\nContent-Length: " +
           std::to_string(body.size()) + "\r\n\r\n" + body;
  }
  std::string ask(const std::string& request) const {
    const Client client(port);
    client.send(request);
    return client.receive();
  }
  /// 0 where there is no answer.
  int statusOf(const std::string& request) const {
    const std::string answer = ask(request);
    return answer.starts_with("HTTP/1.1 ") ? std::stoi(answer.substr(9)) : 0;
  }
  void expectAnswers() const {
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(statusOf(get("/state")), 200);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
  }
  /// Connections that have ended give their threads back a little later.
  void expectNoThreadsLeft() const {
    for (int tries = 0; tries < 1000 && ownStatus("Threads") > threads; ++tries)
      std::this_thread::sleep_for(milliseconds(10));
    EXPECT_LE(ownStatus("Threads"), threads);
  }

  std::promise<void> opened;
  std::shared_future<void> gate = opened.get_future().share();
  std::atomic<int> waiting = 0;
  std::optional<Server> server;
  std::thread thread;
  long threads = 0;  ///< without a client
  int port = 0;
  std::string base;  ///< "/TOKEN"
};

TEST_F(ViewServer, AnswersWhoKnowsTheTokenAndTellsOthersApartByNothing) {
  EXPECT_EQ(base.size(), 33u);
  EXPECT_THAT(ask(get("/")), HasSubstr("\r\n\r\npage"));
  EXPECT_THAT(ask(post("/echo", "[1]")), HasSubstr("\r\n\r\n[1]"));
  std::string other = base;
  other.back() = other.back() == '0' ? '1' : '0';
  const std::string nothing = ask(get("/nothing"));
  EXPECT_THAT(nothing, StartsWith("HTTP/1.1 404 "));
  for (const std::string& path :
       {std::string("/"), std::string("/state"), other + "/state", base + "0/state", base.substr(0, 32) + "/",
        base, "/" + base + "/state", base + "/../etc/passwd", base + "/state?x", "*" + base, base + "/%2e"})
    EXPECT_EQ(ask(head("GET", path, "\r\n")), nothing) << path;
  EXPECT_NE(randomToken(), randomToken());
}

TEST_F(ViewServer, PagesMayRunAndAskOnlyWhatIsTheirOwn) {
  const std::string answer = ask(get("/"));
  EXPECT_THAT(answer, HasSubstr("script-src 'nonce-abc'; style-src 'nonce-abc'"));
  EXPECT_THAT(ask(get("/state")), HasSubstr("default-src 'none'; script-src 'none'; style-src 'none'"));
  for (const char* line :
       {"frame-ancestors 'none'", "X-Content-Type-Options: nosniff", "Referrer-Policy: no-referrer",
        "Cache-Control: no-store", "Cross-Origin-Resource-Policy: same-origin", "connect-src 'self'"})
    EXPECT_THAT(answer, HasSubstr(line));
}

TEST_F(ViewServer, RefusesOtherHostsAndOtherPages) {
  const auto status = [&](const std::string& fields) {
    return statusOf("GET " + base + "/state HTTP/1.1\r\n" + fields + "Connection: close\r\n\r\n");
  };
  char name[256] = "";
  gethostname(name, sizeof name - 1);
  for (const std::string& host :
       {std::string("localhost"), std::string("LOCALHOST:1"), std::string("127.0.0.1:99"),
        std::string("10.0.0.7"), std::string("[::1]:8080"), std::string("[fe80::1]"),
        std::string(name) + ":80"})
    EXPECT_EQ(status("Host: " + host + "\r\n"), 200) << host;
  for (const char* host :
       {"evil.example", "evil.example:80", "127.0.0.1.evil.example", "localhost.evil.example", "",
        "[::1].evil.example", "[]", "[", "]", ":", "a@127.0.0.1", "127.0.0.1,evil.example"})
    EXPECT_EQ(status(std::string("Host: ") + host + "\r\n"), 421) << host;
  EXPECT_EQ(status(""), 421);
  const auto ofPage = [&](const std::string& fields) { return status("Host: localhost:8080\r\n" + fields); };
  EXPECT_EQ(ofPage("Origin: http://localhost:8080\r\nSec-Fetch-Site: same-origin\r\n"), 200);
  EXPECT_EQ(ofPage("Origin: https://localhost:8080\r\n"), 200);
  EXPECT_EQ(ofPage("Sec-Fetch-Site: none\r\n"), 200);
  for (const char* origin : {"http://evil.example", "null", "", "http://localhost", "http://localhost:8081",
                             "http://localhost:8080.evil"})
    EXPECT_EQ(ofPage(std::string("Origin: ") + origin + "\r\n"), 403) << origin;
  EXPECT_EQ(ofPage("Sec-Fetch-Site: cross-site\r\n"), 403);
}

TEST_F(ViewServer, RefusesWhatHasTwoReadings) {
  const std::string is_json = "Content-Type: application/json\r\n", path = base + "/echo";
  const auto posted = [&](const std::string& fields) {
    return statusOf(head("POST", path, fields + "\r\n") + "[]");
  };
  EXPECT_EQ(posted(is_json + "Content-Length: 2\r\nConnection: close\r\n"), 200);
  EXPECT_EQ(
      posted("Content-Type: application/json; charset=utf-8\r\nContent-Length: 2\r\nConnection: close\r\n"),
      200);
  EXPECT_EQ(posted(is_json), 411);
  EXPECT_EQ(posted(is_json + "Content-Length: 2\r\nTransfer-Encoding: chunked\r\n"), 411);
  EXPECT_EQ(posted(is_json + "Content-Length: 2\r\nContent-Length: 2\r\n"), 400);
  EXPECT_EQ(posted(is_json + "Content-Length: -2\r\n"), 400);
  EXPECT_EQ(posted(is_json + "Content-Length: 0x2\r\n"), 400);
  EXPECT_EQ(posted(is_json + "Content-Length: 1048577\r\n"), 413);
  EXPECT_EQ(posted(is_json + "Content-Length: 99999999999999999999999\r\n"), 413);
  for (const char* type :
       {"text/plain", "application/x-www-form-urlencoded", "multipart/form-data", "application/jsonx"})
    EXPECT_EQ(posted(std::string("Content-Type: ") + type + "\r\nContent-Length: 2\r\n"), 415) << type;
  EXPECT_EQ(posted("Content-Length: 2\r\n"), 415);
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "CONNECT", "get", ""})
    EXPECT_EQ(statusOf(head(method, path, "\r\n")), 405) << method;
  EXPECT_EQ(statusOf(head("GET", base + "/state", "Content-Length: 2\r\n\r\n") + "[]"), 400);
  for (const std::string& field :
       {std::string("a b: c"), std::string(" folded"), std::string(": c"), std::string("a: b\nc: d"),
        std::string("a: b\rc"), std::string("a: \0b", 5)})
    EXPECT_EQ(statusOf(head("GET", base + "/state", field + "\r\n\r\n")), 400) << field;
  EXPECT_EQ(statusOf("GET " + base + "/state\r\n\r\n"), 400);
  EXPECT_EQ(statusOf("GET " + base + "/state HTTP/2\r\n\r\n"), 400);
  EXPECT_EQ(statusOf(head("GET", base + "/state", "X: " + std::string(17000, 'a') + "\r\n\r\n")), 431);
}

TEST_F(ViewServer, OneConnectionAsksAgainButDoesNotRunAhead) {
  const Client client(port);
  const auto answerSize = [&](const std::string& request) { return ask(request).size(); };
  const std::string request = head("GET", base + "/state", "\r\n");
  // "keep-alive" has five letters more than "close".
  const std::size_t size = answerSize(get("/state")) + 5;
  for (int i = 0; i < 3; ++i) {
    client.send(request);
    EXPECT_THAT(client.receive(size), HasSubstr("Connection: keep-alive"));
  }
  client.send(request + request);
  const std::string last = client.receive();
  EXPECT_THAT(last, HasSubstr("Connection: close"));
  EXPECT_EQ(last.size(), size - 5) << "one answer, and the connection's end";
}

TEST_F(ViewServer, ErrorsOfHandlersAreTold) {
  EXPECT_THAT(ask(post("/input", "{}")),
              testing::AllOf(StartsWith("HTTP/1.1 422 "), HasSubstr("{\"error\":\"bad ")));
  EXPECT_THAT(ask(post("/machine", "{}")),
              testing::AllOf(StartsWith("HTTP/1.1 500 "), HasSubstr("{\"error\":\"no memory\"}")));
  EXPECT_EQ(ask(head("HEAD", base + "/large", "Connection: close\r\n\r\n")).find("\r\n\r\n") + 4,
            ask(head("HEAD", base + "/large", "Connection: close\r\n\r\n")).size());
}

TEST_F(ViewServer, GigabyteIsRefusedBeforeItIsRead) {
  const std::string is_json = "Content-Type: application/json\r\n", block(std::size_t(1) << 20, 'a');
  std::string fields;
  while (fields.size() < block.size()) fields += "X" + std::to_string(fields.size()) + ": y\r\n";
  const long memory = ownStatus("VmRSS");
  const auto sends = [&](const std::string& begin, const std::string& part) {
    const Client client(port);
    client.send(begin);
    std::size_t blocks = 0;
    while (blocks < 1024 && client.send(part)) ++blocks;
    return blocks;
  };
  EXPECT_LT(sends(head("POST", base + "/echo", is_json + "Content-Length: 1073741824\r\n\r\n"), block), 64u);
  EXPECT_LT(sends(head("POST", base + "/echo", is_json + "Transfer-Encoding: chunked\r\n\r\n"),
                  "100000\r\n" + block + "\r\n"),
            64u);
  EXPECT_LT(sends(head("GET", base + "/state", "X: "), block), 64u);
  EXPECT_LT(sends(head("GET", base + "/state"), fields), 64u);
  EXPECT_LT(sends("", block), 64u);
  EXPECT_LT(ownStatus("VmRSS") - memory, kMostGrowth);
  expectAnswers();
}

TEST_F(ViewServer, TenThousandRandomRequestsLeaveItAnsweringAndGrowNeitherMemoryNorThreads) {
  std::uint64_t seed = 41;
  const auto below = [&](std::size_t count) { return std::size_t(nextBits(seed) % count); };
  const std::vector<std::string> whole{get("/"), get("/state"), post("/echo", "{\"a\": [1, 2]}"),
                                       post("/input", "{}"), head("HEAD", base + "/", "\r\n")};
  const std::vector<std::string> pieces{"\r\n",
                                        "\r\n\r\n",
                                        ": ",
                                        "/",
                                        base,
                                        "HTTP/1.1",
                                        "Host: ",
                                        "chunked",
                                        "Content-Length: 99999",
                                        "Transfer-Encoding: ",
                                        std::string(1, '\0'),
                                        "\xff"};
  const auto randomBytes = [&](std::size_t count) {
    std::string bytes(count, ' ');
    for (char& c : bytes) c = char(nextBits(seed));
    return bytes;
  };
  const auto request = [&]() -> std::string {
    std::string text = whole[below(whole.size())];
    switch (below(6)) {
      case 0:
        return randomBytes(below(300));
      case 1:
        return text.substr(0, below(text.size()));
      case 2:
        return head("GET", "/" + randomBytes(below(40)) + "/state", "\r\n");
      case 3:
        return text.insert(text.find("\r\n") + 2, "X: " + std::string(below(40000), 'a') + "\r\n");
      default:
        for (std::size_t i = below(4) + 1; i > 0; --i)
          text.replace(below(text.size()), below(4),
                       below(2) == 0 ? pieces[below(pieces.size())] : randomBytes(1));
        return text;
    }
  };
  for (int i = 0; i < 200; ++i) ask(get("/state"));
  const long memory = ownStatus("VmRSS");
  int answered = 0, good = 0;
  for (int i = 0; i < 10000; ++i) {
    const Client client(port);
    client.send(request());
    client.sendNoMore();
    const std::string answer = client.receive();
    answered += answer.starts_with("HTTP/1.1 ");
    good += answer.starts_with("HTTP/1.1 200 ");
    ASSERT_TRUE(answer.empty() || answer.starts_with("HTTP/1.1 ")) << i;
  }
  EXPECT_GT(answered, 5000);
  EXPECT_GT(good, 100) << "some are left whole";
  EXPECT_LT(good, 5000);
  expectNoThreadsLeft();
  EXPECT_LT(ownStatus("VmRSS") - memory, kMostGrowth);
  expectAnswers();
}

TEST_F(ViewServer, ClientsKilledInAnAnswerFreeItsMemoryAndTheirThreads) {
  for (int i = 0; i < 20; ++i) ask(get("/large"));
  const long memory = ownStatus("VmRSS");
  for (int i = 0; i < 200; ++i) {
    const Client client(port);
    client.send(get("/large"));
    EXPECT_EQ(client.receive(1000).size(), 1000u);
    client.abort();
  }
  expectNoThreadsLeft();
  EXPECT_LT(ownStatus("VmRSS") - memory, kMostGrowth);
  expectAnswers();
}

TEST_F(ViewServer, SlowClientsDoNotKeepAQuickOneOut) {
  std::vector<std::unique_ptr<Client>> slow;
  for (int i = 0; i < 200; ++i) {
    slow.push_back(std::make_unique<Client>(port));
    slow.back()->send(i % 2 == 0 ? head("GET", base + "/state", "X: ") : std::string());
  }
  expectAnswers();
  for (int i = 0; i < 100; ++i) {
    slow.push_back(std::make_unique<Client>(port));
    slow.back()->send(get("/large"));
    slow.back()->receive(1);  // it is being sent now; the rest is never taken
  }
  expectAnswers();
  EXPECT_LE(ownStatus("Threads"), threads + 65);
}

TEST_F(ViewServer, RequestThatComesByteByByteEndsAfterSomeSeconds) {
  const auto begin = std::chrono::steady_clock::now();
  const Client client(port);
  bool is_open = client.send(head("GET", base + "/state", "X: "));
  while (is_open && std::chrono::steady_clock::now() - begin < std::chrono::seconds(25)) {
    std::this_thread::sleep_for(milliseconds(250));
    is_open = client.send("a");
  }
  EXPECT_FALSE(is_open);
}

TEST_F(ViewServer, SecondClientIsAnsweredWhileTheFirstWaitsAndOneTooManyIsTold) {
  std::vector<std::unique_ptr<Client>> waiters;
  for (int i = 0; i < 16; ++i) {
    waiters.push_back(std::make_unique<Client>(port));
    waiters.back()->send(post("/wait", "{}"));
    while (waiting <= i) std::this_thread::sleep_for(milliseconds(1));
    if (i < 15) expectAnswers();
  }
  EXPECT_EQ(statusOf(get("/state")), 503);
  opened.set_value();
  for (const auto& client : waiters) EXPECT_THAT(client->receive(), StartsWith("HTTP/1.1 200 "));
  expectAnswers();
  opened = {};
}

TEST_F(ViewServer, TakenPortIsToldAndIsFreeAgainWhenItsServerHasEnded) {
  expectAnswers();
  try {
    const Server second({"127.0.0.1", port}, {});
    ADD_FAILURE() << "two servers at one port";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(),
              "--port " + std::to_string(port) + ": taken by another program; give another port, or none");
  }
  EXPECT_THROW(Server({"192.0.2.1", 0}, {}), InputError) << "an address that no machine has";
  EXPECT_THROW(Server({"", 0}, {}), InputError);
  const Client open(port);
  open.send(head("GET", base + "/state", "\r\n"));
  EXPECT_FALSE(open.receive(100).empty());
  server->stop();
  thread.join();
  server.reset();
  server.emplace(ServerSettings{"127.0.0.1", port}, Handlers{});
  thread = std::thread([this] { server->run(); });
  EXPECT_EQ(statusOf(get("/state")), 404) << "another token, and nothing there";
}

}  // namespace
}  // namespace luciole
