#include "experiments/server/request_filter.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "core/base/error.h"

namespace haptrial::experiments {
namespace {

bool is_json(const std::string& content_type) {
  const std::string type = content_type.substr(0, content_type.find(';'));
  return type == "application/json" || type == "application/json ";
}

std::string printable(const std::string& text, std::size_t longest) {
  std::string out;
  for (const char c : text.substr(0, longest)) {
    out += c >= ' ' && c <= '~' ? c : '?';
  }
  return text.size() > longest ? out + "..." : out;
}

}  // namespace

bool is_same_secret(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) {
    return false;
  }
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference |= static_cast<unsigned>(a[i] ^ b[i]);
  }
  return difference == 0;
}

std::string make_token() {
  std::array<unsigned char, 16> bits{};
  if (::getrandom(bits.data(), bits.size(), 0) != static_cast<ssize_t>(bits.size())) {
    throw RunError("the system gave no random numbers for the page's token");
  }
  std::string token;
  for (const unsigned char byte : bits) {
    token += fmt::format("{:02x}", byte);
  }
  return token;
}

std::optional<Refusal> RequestFilter::judge(const RequestHead& head) const {
  if (auto refusal = judge_sender(head)) {
    return refusal;
  }
  const Place* place = place_of(head.path);
  if (place == nullptr) {
    return Refusal{404, "no such page; there are " + places()};
  }
  if (head.method != (place->reads ? "GET" : "POST")) {
    return Refusal{405, fmt::format("this address takes {} only", place->reads ? "GET" : "POST")};
  }
  return judge_body(head);
}

const RequestFilter::Place* RequestFilter::place_of(const std::string& path) const {
  const auto found = std::ranges::find(rules_.places, path, &Place::path);
  return found == rules_.places.end() ? nullptr : &*found;
}

std::string RequestFilter::places() const {
  std::string all;
  for (const Place& place : rules_.places) {
    all += (all.empty() ? "" : ", ") + place.path;
  }
  return all;
}

std::optional<Refusal> RequestFilter::judge_sender(const RequestHead& head) const {
  const auto is_ours = [this](const std::string& host) {
    return std::find(rules_.hosts.begin(), rules_.hosts.end(), host) != rules_.hosts.end();
  };
  if (head.host_headers != 1 || !is_ours(head.host)) {
    return Refusal{421, "the Host is not the page's address"};
  }
  constexpr std::string_view kScheme = "http://";
  if (!head.origin.empty() &&
      (!head.origin.starts_with(kScheme) || !is_ours(head.origin.substr(kScheme.size())))) {
    return Refusal{403, "the Origin is another page"};
  }
  // A link that is followed to the page itself comes from elsewhere, and that is fine.
  const Place* place = place_of(head.path);
  if ((place == nullptr || !place->is_page) && !head.fetch_site.empty() &&
      head.fetch_site != "same-origin" && head.fetch_site != "none") {
    return Refusal{403, "the browser says that another site asks"};
  }
  // EventSource cannot send a header, so that reading may name the token in the address.
  const bool by_query = head.method == "GET" && head.token_header.empty();
  const std::string& token = by_query ? head.token_query : head.token_header;
  if (!is_same_secret(token, rules_.token)) {
    return Refusal{403, token.empty() ? "the token is missing" : "the token is wrong"};
  }
  return std::nullopt;
}

std::optional<Refusal> RequestFilter::judge_body(const RequestHead& head) const {
  if (!head.range.empty()) {  // thousands of ranges make a long answer of a short request
    return Refusal{416, "ranges are not served"};
  }
  if (!head.transfer_encoding.empty()) {
    return Refusal{411, "the body must come with a Content-Length"};
  }
  std::size_t length = 0;
  if (head.method == "POST" || !head.content_length.empty()) {
    const char* begin = head.content_length.data();
    const char* end = begin + head.content_length.size();
    const auto [rest, error] = std::from_chars(begin, end, length);
    if (error == std::errc::result_out_of_range) {
      return Refusal{413, "the body is too long"};
    }
    if (error != std::errc{} || rest != end) {
      return Refusal{411, "the body must come with a Content-Length"};
    }
  }
  if (length > (head.method == "POST" ? rules_.max_body : 0)) {
    return Refusal{413, fmt::format("the body has {} bytes; allowed: {}", length,
                                    head.method == "POST" ? rules_.max_body : 0)};
  }
  if (head.method == "POST" && (!is_json(head.content_type) || !head.content_encoding.empty())) {
    return Refusal{415, "the body must be plain application/json"};
  }
  return std::nullopt;
}

void RefusalLog::add(const std::string& sentence) {
  const std::string text = printable(sentence, 300);
  {
    const std::lock_guard lock(mutex_);
    ++count_;
    if (sentences_.size() >= kKept) {
      return;
    }
    sentences_.push_back(text);
  }
  if (listener_) {
    listener_(text);
  }
}

std::uint64_t RefusalLog::count() const {
  const std::lock_guard lock(mutex_);
  return count_;
}

std::vector<std::string> RefusalLog::sentences() const {
  const std::lock_guard lock(mutex_);
  return sentences_;
}

}  // namespace haptrial::experiments
