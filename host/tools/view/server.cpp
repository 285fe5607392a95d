#include "tools/view/server.hpp"

#include <arpa/inet.h>
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
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>
#include <thread>
#include <utility>

#include "base/dump_utf8.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

using ServerClock = std::chrono::steady_clock;
using Deadline = ServerClock::time_point;

constexpr std::size_t kMostConnections = 64, kMostAnswered = 16, kMostHeadBytes = 16384,
                      kMostBodyBytes = std::size_t(1) << 20;
constexpr std::chrono::seconds kIdle{30}, kToAsk{15}, kToTake{120};

/// A status of HTTP that refuses a request, and why.
struct Refusal {
  int status;
  const char* reason;
};

/// What stands before the body of a request.
struct RequestHead {
  std::string method, path;  ///< GET, HEAD or POST; POST has a body of JSON
  std::size_t body_bytes = 0;
  bool stays_open = true;  ///< the connection
};

std::string inLowerCase(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return text;
}

/// The text until `separator`, which is taken off with it; all where there is none.
std::string_view takeUntil(std::string_view& text, std::string_view separator) {
  const std::size_t at = text.find(separator);
  const std::string_view part = text.substr(0, at);
  text = at == std::string_view::npos ? std::string_view() : text.substr(at + separator.size());
  return part;
}

/// host: as Host has it, in lower case. Tunnels change the port, so any will do.
bool isThisMachine(const std::string& host, const std::string& machine_name) {
  const std::size_t end = host.find_last_of(":]");
  const std::string name = end != std::string::npos && host[end] == ':' ? host.substr(0, end) : host;
  in6_addr address{};
  if (name.starts_with('[') && name.ends_with(']'))
    return inet_pton(AF_INET6, name.substr(1, name.size() - 2).c_str(), &address) == 1;
  return name == "localhost" || (!name.empty() && name == inLowerCase(machine_name)) ||
         inet_pton(AF_INET, name.c_str(), &address) == 1;
}

/// The part of HTTP/1.1 that our page needs; text: until the empty line. Throws Refusal: of what is unusual,
/// so that nothing has two readings, and of what is for another host or from another page. Any page in a
/// browser can ask: Origin and Sec-Fetch-Site tell, and Host where its server's name was made to lead here.
RequestHead parseHead(std::string_view text, const std::string& machine_name) {
  RequestHead head;
  std::map<std::string, std::string> fields;  // by their names in lower case
  std::string_view line = takeUntil(text, "\r\n");
  head.method = takeUntil(line, " ");
  head.path = takeUntil(line, " ");
  if (line != "HTTP/1.1") throw Refusal{400, "expected HTTP/1.1"};
  while (!text.empty()) {
    line = takeUntil(text, "\r\n");
    const auto isControl = [](char c) { return (c >= 0 && c < ' ' && c != '\t') || c == '\x7f'; };
    const bool is_plain = std::none_of(line.begin(), line.end(), isControl);
    const std::string name = inLowerCase(std::string(takeUntil(line, ":")));
    const std::size_t begin = line.find_first_not_of(" \t"), end = line.find_last_not_of(" \t");
    if (begin != std::string_view::npos) line = line.substr(begin, end + 1 - begin);
    if (!is_plain || name.empty() || name.find_first_of(" \t") != std::string::npos ||
        !fields.emplace(name, inLowerCase(std::string(line))).second)
      throw Refusal{400, "expected fields as NAME: VALUE, each once"};
  }
  const auto field = [&](const char* name) { return fields.contains(name) ? fields[name] : std::string(); };
  const std::string host = field("host"), origin = field("origin"), length = field("content-length");
  if (!isThisMachine(host, machine_name))
    throw Refusal{421, "expected localhost, this machine's name or its address as Host"};
  const bool is_own = origin == "http://" + host || origin == "https://" + host;  // a tunnel may have TLS
  if ((fields.contains("origin") && !is_own) || field("sec-fetch-site") == "cross-site")
    throw Refusal{403, "from another page"};
  if (head.method != "GET" && head.method != "HEAD" && head.method != "POST")
    throw Refusal{405, "expected GET, HEAD or POST"};
  if (fields.contains("transfer-encoding") || (head.method == "POST" && length.empty()))
    throw Refusal{411, "expected Content-Length"};
  if (length.find_first_not_of("0123456789") != std::string::npos)
    throw Refusal{400, "expected a number as Content-Length"};
  if (length.size() > 9 || (!length.empty() && std::stoul(length) > kMostBodyBytes))
    throw Refusal{413, "more than 1 MiB"};
  head.body_bytes = length.empty() ? 0 : std::stoul(length);
  if (head.method != "POST" && head.body_bytes > 0) throw Refusal{400, "only POST has a body"};
  const std::string type = field("content-type");
  if (head.method == "POST" && type.substr(0, type.find_first_of("; \t")) != "application/json")
    throw Refusal{415, "expected application/json"};
  head.stays_open = field("connection") != "close";
  return head;
}

/// Until something can be received or sent; false at the deadline.
bool awaitSocket(int socket, short event, Deadline deadline) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - ServerClock::now()).count();
  pollfd polled{socket, event, 0};
  return left > 0 && (poll(&polled, 1, int(left)) > 0 || errno == EINTR);
}

/// Adds what has come. False at the connection's end and at the deadline.
bool receiveMore(int socket, std::string& bytes, Deadline deadline) {
  std::array<char, 16384> part;
  while (awaitSocket(socket, POLLIN, deadline)) {
    const ssize_t count = recv(socket, part.data(), part.size(), MSG_DONTWAIT);
    if (count > 0) bytes.append(part.data(), std::size_t(count));
    if (count >= 0 || (errno != EAGAIN && errno != EINTR)) return count > 0;
  }
  return false;
}

bool sendAll(int socket, std::string_view bytes, Deadline deadline) {
  while (!bytes.empty() && awaitSocket(socket, POLLOUT, deadline)) {
    const ssize_t count = send(socket, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (count < 0 && errno != EAGAIN && errno != EINTR) return false;
    bytes.remove_prefix(std::size_t(std::max(count, ssize_t(0))));
  }
  return bytes.empty();
}

bool sendAnswer(int socket, const Answer& answer, bool has_body, bool stays_open) {
  const std::string own = answer.nonce.empty() ? "'none'" : "'nonce-" + answer.nonce + "'";
  const std::string head = fmt::format(
      "HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: {}\r\n"
      "Content-Security-Policy: default-src 'none'; script-src {}; style-src {}; img-src blob: data:; "
      "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n"
      "Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n"
      "Cross-Origin-Resource-Policy: same-origin\r\n\r\n",
      answer.status, answer.status < 400 ? "OK" : "Refused", answer.type, answer.body.size(),
      stays_open ? "keep-alive" : "close", own, own);
  const Deadline deadline = ServerClock::now() + kToTake;
  return sendAll(socket, head, deadline) && (!has_body || sendAll(socket, answer.body, deadline));
}

Answer errorAnswer(int status, const std::string& reason) {
  return {status, "application/json", dumpUtf8(nlohmann::json{{"error", reason}}), ""};
}

/// Takes as long for any text of the token's length.
bool isToken(std::string_view given, std::string_view token) {
  unsigned difference = given.size() != token.size();
  for (std::size_t i = 0; i < std::min(given.size(), token.size()); ++i)
    difference |= unsigned(given[i]) ^ unsigned(token[i]);
  return difference == 0;
}

int listenAt(const ServerSettings& settings) {
  addrinfo hints{}, *found = nullptr;
  hints.ai_socktype = SOCK_STREAM;
  const std::string port = std::to_string(settings.port);
  if (const int error = getaddrinfo(settings.host.c_str(), port.c_str(), &hints, &found))
    throw InputError(fmt::format("--host {}: {}; expected a name or an address of this machine",
                                 settings.host, gai_strerror(error)));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> first(found, freeaddrinfo);
  const int socket = ::socket(first->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0), on = 1;
  // So that the port of a server that has just ended is free. Not SO_REUSEPORT: two servers would share it.
  if (socket >= 0 && setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) == 0 &&
      bind(socket, first->ai_addr, first->ai_addrlen) == 0 && listen(socket, SOMAXCONN) == 0)
    return socket;
  const int error = errno;
  close(socket);
  if (error == EADDRINUSE || error == EACCES)
    throw InputError(fmt::format("--port {}: {}; give another port, or none", settings.port,
                                 error == EACCES ? "not for this user" : "taken by another program"));
  if (error == EADDRNOTAVAIL)
    throw InputError(fmt::format("--host {}: no address of this machine", settings.host));
  throw MachineError(fmt::format("no socket to listen at: {}", std::strerror(error)));
}

}  // namespace

/// What a client does, those first that can be given up.
enum class Server::Stage { kAsks, kTakes, kIsAnswered };

struct Server::Connection {
  int socket;
  Stage stage = Stage::kAsks;
  Deadline since = ServerClock::now();
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
  sockaddr_storage bound{};
  socklen_t size = sizeof bound;
  getsockname(socket_, reinterpret_cast<sockaddr*>(&bound), &size);
  const int port = ntohs(reinterpret_cast<const sockaddr_in&>(bound).sin_port);  // as in a sockaddr_in6
  std::string host = settings.host == "0.0.0.0" || settings.host == "::" ? machine_name_ : settings.host;
  if (host.find(':') != std::string::npos) host = "[" + host + "]";
  address_ = fmt::format("http://{}:{}/{}/", host, port, token_);
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
    std::unique_lock lock(mutex_);
    if (socket < 0 && !stops_) {
      is_gone_.wait_for(lock, std::chrono::milliseconds(50));  // no file or memory for one
      continue;
    }
    const auto oldest =
        std::min_element(connections_.begin(), connections_.end(), [](const auto& a, const auto& b) {
          return std::pair(a.stage, a.since) < std::pair(b.stage, b.since);
        });
    const auto hasRoom = [&] { return connections_.size() < kMostConnections; };
    if (!hasRoom() && oldest->stage != Stage::kIsAnswered) shutdown(oldest->socket, SHUT_RDWR);
    if (!stops_ && is_gone_.wait_for(lock, std::chrono::seconds(1), hasRoom)) {
      const auto connection = connections_.insert(connections_.end(), {socket});
      try {
        std::thread([this, connection] { serve(connection); }).detach();
        continue;
      } catch (const std::exception&) {  // no thread
        connections_.erase(connection);
      }
    }
    close(socket);
    if (!stops_) continue;
    is_gone_.wait(lock, [&] { return connections_.empty(); });
    return;
  }
}

void Server::serve(std::list<Connection>::iterator connection) {
  const int on = 1;
  setsockopt(connection->socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  try {
    while (answerNext(*connection)) continue;
  } catch (const std::exception&) {  // no memory
  }
  const std::lock_guard lock(mutex_);
  close(connection->socket);
  connections_.erase(connection);
  is_gone_.notify_all();
}

/// False where the connection ends.
bool Server::answerNext(Connection& connection) {
  const int socket = connection.socket;
  const auto begin = [&](Stage stage) {
    const std::lock_guard lock(mutex_);
    const auto isAnswered = [](const Connection& one) { return one.stage == Stage::kIsAnswered; };
    if (stage == Stage::kIsAnswered &&
        std::size_t(std::count_if(connections_.begin(), connections_.end(), isAnswered)) == kMostAnswered)
      throw Refusal{503, "too many requests at once"};
    connection.stage = stage;
    connection.since = ServerClock::now();
  };
  begin(Stage::kAsks);
  std::string received;
  if (!receiveMore(socket, received, ServerClock::now() + kIdle)) return false;
  const Deadline deadline = ServerClock::now() + kToAsk;
  std::size_t end;
  while ((end = received.find("\r\n\r\n")) == std::string::npos && received.size() <= kMostHeadBytes)
    if (!receiveMore(socket, received, deadline)) return false;
  Answer refused;
  try {
    if (end > kMostHeadBytes) throw Refusal{431, "more than 16 KiB before the body"};
    const RequestHead head = parseHead(std::string_view(received).substr(0, end), machine_name_);
    const std::size_t slash = std::min(head.path.find('/', 1), head.path.size());
    const std::string path = head.path.substr(slash);
    if (!isToken(std::string_view(head.path).substr(0, slash), "/" + token_) ||
        !(head.method == "POST" ? handlers_.post.contains(path) : handlers_.get.contains(path)))
      throw Refusal{404, "nothing is here; the address has to be the one that the program printed"};
    received.erase(0, end + 4);
    while (received.size() < head.body_bytes)
      if (!receiveMore(socket, received, deadline)) return false;
    // What comes without waiting for the answer is not read.
    const bool stays_open = head.stays_open && received.size() == head.body_bytes;
    received.resize(head.body_bytes);
    begin(Stage::kIsAnswered);
    const bool is_post = head.method == "POST";
    const Answer answer = is_post ? handlers_.post.at(path)(received) : handlers_.get.at(path)();
    begin(Stage::kTakes);
    return sendAnswer(socket, answer, head.method != "HEAD", stays_open) && stays_open;
  } catch (const Refusal& refusal) {
    refused = errorAnswer(refusal.status, refusal.reason);
  } catch (const InputError& error) {
    refused = errorAnswer(422, error.what());
  } catch (const std::exception& error) {
    refused = errorAnswer(500, error.what());
  }
  sendAnswer(socket, refused, true, false);
  return false;
}

}  // namespace luciole
