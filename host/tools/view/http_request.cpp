#include "tools/view/http_request.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>

namespace luciole {
namespace {

std::string inLowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return lower;
}

bool isWordOfHttp(std::string_view text) {
  constexpr std::string_view kOthers = "!#$%&'*+-.^_`|~";
  return !text.empty() && std::all_of(text.begin(), text.end(), [&](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
           kOthers.find(c) != std::string_view::npos;
  });
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t");
  return begin == std::string_view::npos ? std::string_view() : text.substr(begin, end + 1 - begin);
}

/// The text until `separator`, which is taken off with it; all where there is none.
std::string_view takeUntil(std::string_view& text, std::string_view separator) {
  const std::size_t at = text.find(separator);
  const std::string_view part = text.substr(0, at);
  text = at == std::string_view::npos ? std::string_view() : text.substr(at + separator.size());
  return part;
}

bool isNumber(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// host: as Host has it, in lower case. Tunnels change the port, so any will do.
bool isThisMachine(const std::string& host, const std::string& machine_name) {
  const bool is_bracketed = host.starts_with('[');
  const std::size_t colon = is_bracketed ? host.find("]:") : host.find(':');
  if (colon != std::string::npos && !isNumber(host.substr(colon + (is_bracketed ? 2 : 1)))) return false;
  const std::string name =
      host.substr(0, colon == std::string::npos ? colon : colon + (is_bracketed ? 1 : 0));
  in6_addr address{};
  if (is_bracketed)
    return name.ends_with(']') && inet_pton(AF_INET6, name.substr(1, name.size() - 2).c_str(), &address) == 1;
  return name == "localhost" || (!name.empty() && name == inLowerCase(machine_name)) ||
         inet_pton(AF_INET, name.c_str(), &address) == 1;
}

}  // namespace

const std::string& RequestHead::field(const std::string& name) const {
  static const std::string kNone;
  const auto found = fields.find(name);
  return found == fields.end() ? kNone : found->second;
}

std::optional<RequestHead> parseHead(std::string_view text) {
  RequestHead head;
  std::string_view line = takeUntil(text, "\r\n");
  head.method = takeUntil(line, " ");
  head.path = takeUntil(line, " ");
  const auto isPrinted = [](char c) { return c > ' ' && c <= '~'; };
  if (!isWordOfHttp(head.method) || !head.path.starts_with('/') ||
      (line != "HTTP/1.1" && line != "HTTP/1.0") ||
      !std::all_of(head.path.begin(), head.path.end(), isPrinted))
    return std::nullopt;
  head.stays_open = line == "HTTP/1.1";
  while (!text.empty()) {
    line = takeUntil(text, "\r\n");
    const auto isControl = [](char c) { return (c >= 0 && c < ' ' && c != '\t') || c == '\x7f'; };
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || !isWordOfHttp(line.substr(0, colon)) ||
        std::any_of(line.begin(), line.end(), isControl))
      return std::nullopt;
    std::string& value = head.fields[inLowerCase(line.substr(0, colon))];
    if (!value.empty()) value += ", ";
    value += trimmed(line.substr(colon + 1));
  }
  if (inLowerCase(head.field("connection")) == "close") head.stays_open = false;
  return head;
}

Refusal refuseForeign(const RequestHead& head, const std::string& machine_name) {
  const std::string host = inLowerCase(head.field("host"));
  if (!isThisMachine(host, machine_name))
    return {421, "for another host: expected localhost, this machine's name or its address"};
  const std::string origin = inLowerCase(head.field("origin"));
  const bool is_own = origin == "http://" + host || origin == "https://" + host;  // a tunnel may have TLS
  if ((head.fields.contains("origin") && !is_own) || head.field("sec-fetch-site") == "cross-site")
    return {403, "from another page"};
  return {};
}

Refusal refuseBody(const RequestHead& head, std::size_t& bytes) {
  bytes = 0;
  const std::string& length = head.field("content-length");
  const bool has_length = head.fields.contains("content-length");
  if (head.fields.contains("transfer-encoding") || (head.method == "POST" && !has_length))
    return {411, "expected Content-Length"};
  if (has_length && !isNumber(length)) return {400, "expected a number as Content-Length"};
  if (head.method != "POST")
    return length.find_first_not_of('0') == std::string::npos ? Refusal{} : Refusal{400, "a body of GET"};
  if (length.size() > 9 || std::stoul(length) > kMostBodyBytes) return {413, "more than 1 MiB"};
  bytes = std::stoul(length);
  const std::string type = inLowerCase(head.field("content-type"));
  if (trimmed(type.substr(0, type.find(';'))) != "application/json" ||
      head.fields.contains("content-encoding"))
    return {415, "expected application/json"};
  return {};
}

}  // namespace luciole
