#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>

// The part of HTTP/1.1 that a page of ours needs. Whatever is unusual is refused, so nothing has two
// readings.
namespace luciole {

inline constexpr std::size_t kMostHeadBytes = std::size_t(16) << 10;
inline constexpr std::size_t kMostBodyBytes = std::size_t(1) << 20;

/// What stands before the body of a request.
struct RequestHead {
  std::string method, path;
  bool stays_open = true;                     ///< the connection, after the answer
  std::map<std::string, std::string> fields;  ///< by their names in lower case; repeated ones joined by ", "

  const std::string& field(const std::string& name) const;  ///< "" where there is none
};

/// text: without the empty line at its end. Nothing where it is no request.
std::optional<RequestHead> parseHead(std::string_view text);

/// A status of HTTP that refuses a request, and why.
struct Refusal {
  int status = 0;  ///< 0: not refused
  const char* reason = "";
};

/// Whether a request is for this server and from its own page. Other pages that a browser shows could ask it,
/// too: they are told by Origin and Sec-Fetch-Site, and by Host where their name has become this machine's
/// address. machine_name: what the machine is called, beside localhost and any address in numbers.
Refusal refuseForeign(const RequestHead& head, const std::string& machine_name);

/// Whether a request's body can be read; sets its bytes.
Refusal refuseBody(const RequestHead& head, std::size_t& bytes);

}  // namespace luciole
