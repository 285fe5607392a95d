#include "tools/view/server.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "base/dump_utf8.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

using ServerClock = std::chrono::steady_clock;
using Deadline = ServerClock::time_point;

constexpr std::size_t kMostConnections = 64;
constexpr int kMostAnswering = 16;
constexpr std::chrono::seconds kIdle{30}, kToAsk{15}, kToAnswer{120};

bool awaitSocket(int socket, short event, Deadline deadline) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - ServerClock::now());
  pollfd polled{socket, event, 0};
  if (left.count() <= 0) return false;
  const int ready = poll(&polled, 1, int(left.count()) + 1);
  return ready > 0 || (ready < 0 && errno == EINTR);
}

/// Adds what has come. False at the connection's end and after the deadline.
bool receiveMore(int socket, std::string& bytes, Deadline deadline) {
  std::array<char, 16384> part;
  for (;;) {
    const ssize_t count = recv(socket, part.data(), part.size(), MSG_DONTWAIT);
    if (count > 0) bytes.append(part.data(), std::size_t(count));
    if (count >= 0) return count > 0;
    if (errno != EAGAIN && errno != EINTR) return false;
    if (!awaitSocket(socket, POLLIN, deadline)) return false;
  }
}

bool sendAll(int socket, std::string_view bytes, Deadline deadline) {
  while (!bytes.empty()) {
    const ssize_t count = send(socket, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (count > 0) bytes.remove_prefix(std::size_t(count));
    if (count < 0 && errno != EAGAIN && errno != EINTR) return false;
    if (count < 0 && !awaitSocket(socket, POLLOUT, deadline)) return false;
  }
  return true;
}

Answer errorAnswer(int status, const std::string& reason) {
  return {status, "application/json", dumpUtf8(nlohmann::json{{"error", reason}}), ""};
}

bool sendAnswer(int socket, const Answer& answer, bool is_head, bool stays_open) {
  const std::string own = answer.nonce.empty() ? "'none'" : "'nonce-" + answer.nonce + "'";
  std::string text = fmt::format(
      "HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: {}\r\nCache-Control: "
      "no-store\r\n"
      "Content-Security-Policy: default-src 'none'; script-src {}; style-src {}; img-src blob: data:; "
      "connect-src "
      "'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\nX-Content-Type-Options: "
      "nosniff\r\n"
      "Referrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\n\r\n",
      answer.status, answer.status < 400 ? "OK" : "Refused", answer.type, answer.body.size(),
      stays_open ? "keep-alive" : "close", own, own);
  const Deadline deadline = ServerClock::now() + kToAnswer;
  return sendAll(socket, text, deadline) && (is_head || sendAll(socket, answer.body, deadline));
}

/// Takes as long for any wrong token.
bool isToken(std::string_view given, std::string_view token) {
  unsigned difference = given.size() != token.size();
  for (std::size_t i = 0; i < token.size(); ++i)
    difference |= unsigned(i < given.size() ? given[i] : 0) ^ unsigned(token[i]);
  return difference == 0;
}

/// Of "--port" and "--host", the arguments. Throws InputError and MachineError.
[[noreturn]] void refuseListening(const ServerSettings& settings, int error) {
  if (error == EADDRINUSE)
    throw InputError(fmt::format(
        "--port {}: taken by another program; give another one, or none for a free one", settings.port));
  if (error == EACCES)
    throw InputError(fmt::format("--port {}: not allowed to this user; those from 1024 are", settings.port));
  if (error == EADDRNOTAVAIL || error == EAFNOSUPPORT)
    throw InputError(fmt::format("--host {}: no address of this machine", settings.host));
  throw MachineError(fmt::format("no socket to listen at: {}", std::strerror(error)));
}

int listenAt(const ServerSettings& settings) {
  addrinfo hints{}, *found = nullptr;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICSERV | AI_PASSIVE;
  if (const int error =
          getaddrinfo(settings.host.c_str(), std::to_string(settings.port).c_str(), &hints, &found))
    throw InputError(
        fmt::format("--host {}: {}; expected a name or an address of this machine, such as 127.0.0.1",
                    settings.host, gai_strerror(error)));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> all(found, freeaddrinfo);
  int error = EADDRNOTAVAIL;
  for (const addrinfo* one = found; one; one = one->ai_next) {
    const int socket = ::socket(one->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0), on = 1;
    // So that the port of a server that has just ended is free. Not SO_REUSEPORT: two servers would share it.
    if (socket >= 0 && setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) == 0 &&
        bind(socket, one->ai_addr, one->ai_addrlen) == 0 && listen(socket, 64) == 0)
      return socket;
    error = errno;
    if (socket >= 0) close(socket);
  }
  refuseListening(settings, error);
}

int portOf(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  // Both kinds of addresses have the port in one place.
  return ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

}  // namespace

struct Server::Connection {
  int socket;
  bool awaits = true;  ///< a request
  Deadline since = ServerClock::now();
  std::string received{};
};

std::string randomToken() {
  std::array<std::uint8_t, 16> bits{};
  if (getentropy(bits.data(), bits.size()) != 0) throw MachineError("the system gives no random numbers");
  return fmt::format("{:02x}", fmt::join(bits, ""));
}

Server::Server(const ServerSettings& settings, Handlers handlers)
    : handlers_(std::move(handlers)), token_(randomToken()), socket_(listenAt(settings)) {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  machine_name_ = name.data();
  const bool is_any = settings.host == "0.0.0.0" || settings.host == "::";
  std::string host = is_any ? machine_name_ : settings.host;
  if (host.find(':') != std::string::npos) host = "[" + host + "]";
  address_ = fmt::format("http://{}:{}/{}/", host, portOf(socket_), token_);
}

Server::~Server() { close(socket_); }

void Server::stop() {
  const std::lock_guard lock(mutex_);
  stops_ = true;
  shutdown(socket_, SHUT_RDWR);  // ends accept4()
  for (const Connection& connection : connections_) shutdown(connection.socket, SHUT_RDWR);
}

void Server::run() {
  for (;;) {
    const int socket = accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
    const int error = errno;
    std::unique_lock lock(mutex_);
    if (stops_) {
      if (socket >= 0) close(socket);
      is_gone_.wait(lock, [&] { return connections_.empty(); });
      return;
    }
    if (socket >= 0) {
      makeRoom(lock);
      lock.unlock();
      accept(socket);
    } else if (error == EBADF || error == EINVAL) {
      throw MachineError(fmt::format("connections can't be accepted any longer: {}", std::strerror(error)));
    } else if (error == EMFILE || error == ENFILE || error == ENOBUFS || error == ENOMEM) {
      is_gone_.wait_for(lock, std::chrono::milliseconds(100));
    }
  }
}

/// Waits until there is one connection less than may be, for a second at most.
void Server::makeRoom(std::unique_lock<std::mutex>& lock) {
  if (connections_.size() < kMostConnections) return;
  const auto oldest =
      std::min_element(connections_.begin(), connections_.end(), [](const auto& a, const auto& b) {
        return std::pair(!a.awaits, a.since) < std::pair(!b.awaits, b.since);
      });
  if (oldest->awaits) shutdown(oldest->socket, SHUT_RDWR);
  is_gone_.wait_for(lock, std::chrono::seconds(1), [&] { return connections_.size() < kMostConnections; });
}

void Server::accept(int socket) {
  const int on = 1;
  setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  std::unique_lock lock(mutex_);
  if (connections_.size() >= kMostConnections) {
    lock.unlock();
    sendAnswer(socket, errorAnswer(503, "too many connections"), false, false);
    close(socket);
    return;
  }
  const auto connection = connections_.insert(connections_.end(), {socket});
  const auto serve = [this, connection] {
    try {
      while (answerNext(*connection)) continue;
    } catch (const std::exception&) {  // no memory
    }
    const std::lock_guard last(mutex_);
    close(connection->socket);
    connections_.erase(connection);
    is_gone_.notify_all();
  };
  try {
    std::thread(serve).detach();
  } catch (const std::exception&) {  // no thread
    close(socket);
    connections_.erase(connection);
  }
}

/// False where the connection ends.
bool Server::answerNext(Connection& connection) {
  const auto await = [&](bool awaits) {
    const std::lock_guard lock(mutex_);
    connection.awaits = awaits;
    connection.since = ServerClock::now();
    return !stops_;
  };
  std::string& received = connection.received;
  if (!await(true)) return false;
  if (received.empty() && !receiveMore(connection.socket, received, ServerClock::now() + kIdle)) return false;
  const Deadline deadline = ServerClock::now() + kToAsk;
  std::size_t end;
  while ((end = received.find("\r\n\r\n")) == std::string::npos && received.size() <= kMostHeadBytes)
    if (!receiveMore(connection.socket, received, deadline)) return false;
  const std::optional<RequestHead> head =
      end <= kMostHeadBytes ? parseHead(std::string_view(received).substr(0, end)) : std::nullopt;
  const auto refuseNow = [&](const Refusal& refusal) {
    sendAnswer(connection.socket, errorAnswer(refusal.status, refusal.reason), head && head->method == "HEAD",
               false);
    return false;
  };
  if (!head) return refuseNow({400, "no request of HTTP/1.1"});
  std::string path;
  std::size_t bytes = 0;
  Refusal refusal = refuse(*head, path);
  if (refusal.status == 0) refusal = refuseBody(*head, bytes);
  if (refusal.status != 0) return refuseNow(refusal);
  received.erase(0, end + 4);
  if (head->field("expect") == "100-continue" && received.size() < bytes &&
      !sendAll(connection.socket, "HTTP/1.1 100 Continue\r\n\r\n", deadline))
    return false;
  while (received.size() < bytes)
    if (!receiveMore(connection.socket, received, deadline)) return false;
  const std::string body = received.substr(0, bytes);
  received = received.substr(bytes);
  if (!await(false)) return false;
  const Answer made = answer(*head, path, body);
  return sendAnswer(connection.socket, made, head->method == "HEAD", head->stays_open) && head->stays_open;
}

/// Sets the path behind the token.
Refusal Server::refuse(const RequestHead& head, std::string& path) const {
  if (const Refusal foreign = refuseForeign(head, machine_name_); foreign.status != 0) return foreign;
  const std::size_t slash = head.path.find('/', 1);
  path = slash == std::string::npos ? "" : head.path.substr(slash);
  const bool is_get = handlers_.get.contains(path), is_post = handlers_.post.contains(path);
  if (!isToken(std::string_view(head.path).substr(1, slash - 1), token_) || (!is_get && !is_post))
    return {404, "nothing is here; the address has to be the one that the program printed"};
  const bool gets = head.method == "GET" || head.method == "HEAD";
  if ((gets && is_get) || (head.method == "POST" && is_post)) return {};
  return {405, "expected GET, HEAD or POST, where each is answered"};
}

Answer Server::answer(const RequestHead& head, const std::string& path, const std::string& body) {
  {
    const std::lock_guard lock(mutex_);
    if (answering_ == kMostAnswering) return errorAnswer(503, "too many requests at once");
    ++answering_;
  }
  const auto done = [this](void*) {
    const std::lock_guard lock(mutex_);
    --answering_;
  };
  const std::unique_ptr<void, decltype(done)> counted(this, done);
  try {
    return head.method == "POST" ? handlers_.post.at(path)(body) : handlers_.get.at(path)();
  } catch (const InputError& error) {
    return errorAnswer(422, error.what());
  } catch (const std::exception& error) {
    return errorAnswer(500, error.what());
  }
}

}  // namespace luciole
