#pragma once

#include <condition_variable>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <string>

#include "tools/view/http_request.hpp"

// A server of HTTP for a page and the programs of one user. It knows nothing of pictures, and no path of a
// request becomes a file's. Debian's cpp-httplib bounds less (12's has neither lines, fields nor chunked
// bodies bounded, none has a deadline for a whole request), and OpenSSL and Brotli would come with it into
// the start of every command.
namespace luciole {

struct Answer {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::string nonce;  ///< of a page's scripts and styles, from randomToken(); "": none may run
};

/// By the path behind the token: "/", "/state". Several threads call them at once. InputError becomes status
/// 422 and another exception 500, with {"error": its message}.
struct Handlers {
  std::map<std::string, std::function<Answer()>> get;
  std::map<std::string, std::function<Answer(const std::string& body)>> post;
};

struct ServerSettings {
  std::string host = "127.0.0.1";  ///< a name or an address of this machine
  int port = 0;                    ///< 0: a free one
};

/// 128 random bits of the system's, as 32 hexadecimal digits. Throws MachineError.
std::string randomToken();

/// A thread for each connection, which bounds them: where they are full, the one goes whose request has been
/// awaited longest. No client is remembered beyond its connection.
class Server {
 public:
  /// Listens. Throws InputError where it can't at this host and port, and MachineError.
  Server(const ServerSettings& settings, Handlers handlers);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// http://HOST:PORT/TOKEN/. Without the token all there is to get is status 404.
  const std::string& address() const { return address_; }

  /// Serves until stop(), and then returns when the last handler has. Throws MachineError.
  void run();

  /// Ends run(), from any thread.
  void stop();

 private:
  struct Connection;
  void accept(int socket);
  void makeRoom(std::unique_lock<std::mutex>& lock);
  bool answerNext(Connection& connection);
  Answer answer(const RequestHead& head, const std::string& path, const std::string& body);
  Refusal refuse(const RequestHead& head, std::string& path) const;

  Handlers handlers_;
  std::string token_, machine_name_, address_;
  int socket_ = -1;
  std::mutex mutex_;                 ///< for what follows
  std::condition_variable is_gone_;  ///< a connection
  std::list<Connection> connections_;
  int answering_ = 0;  ///< handlers that run
  bool stops_ = false;
};

}  // namespace luciole
