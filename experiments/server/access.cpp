#include "experiments/server/access.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>

#include <array>

#include "core/base/error.h"

namespace haptrial::experiments {

std::vector<std::string> server_hosts(const std::string& address, bool loopback, int port) {
  in6_addr v6{};
  std::array<char, INET6_ADDRSTRLEN> text{};
  std::vector<std::string> hosts{fmt::format("{}:{}", address, port)};
  if (::inet_pton(AF_INET6, address.c_str(), &v6) == 1) {
    ::inet_ntop(AF_INET6, &v6, text.data(), text.size());  // the spelling that browsers send
    hosts = {fmt::format("[{}]:{}", text.data(), port)};
  }
  if (loopback) {
    hosts.push_back(fmt::format("localhost:{}", port));
  }
  return hosts;
}

bool check_server_address(const std::string& address, bool allow_remote) {
  in_addr v4{};
  in6_addr v6{};
  const bool is_v4 = ::inet_pton(AF_INET, address.c_str(), &v4) == 1;
  const bool is_v6 = ::inet_pton(AF_INET6, address.c_str(), &v6) == 1;
  const bool any = (is_v4 && v4.s_addr == INADDR_ANY) || (is_v6 && IN6_IS_ADDR_UNSPECIFIED(&v6));
  if ((!is_v4 && !is_v6) || any) {
    throw InputError(
        fmt::format("the page's address is '{}'; allowed: the numeric address of one network "
                    "interface, such as 127.0.0.1",
                    address));
  }
  const bool loopback =
      is_v4 ? (ntohl(v4.s_addr) >> 24) == IN_LOOPBACKNET : IN6_IS_ADDR_LOOPBACK(&v6) != 0;
  if (!loopback && !allow_remote) {
    throw InputError(
        fmt::format("the page's address {} can be reached from other machines; add --remote, or "
                    "choose 127.0.0.1 or ::1",
                    address));
  }
  return loopback;
}

std::string page_with_nonce(std::string_view html, const std::string& nonce) {
  constexpr std::string_view kPlace = "NONCE";
  std::string page(html);
  for (auto at = page.find(kPlace); at != std::string::npos; at = page.find(kPlace, at)) {
    page.replace(at, kPlace.size(), nonce);
  }
  return page;
}

std::string page_policy(const std::string& nonce) {
  return fmt::format(
      "default-src 'none'; script-src 'nonce-{0}'; style-src 'nonce-{0}'; connect-src 'self'; "
      "img-src 'self' data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
      nonce);
}

}  // namespace haptrial::experiments
