#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace haptrial::experiments {

/// @param address  numeric, of one network interface; "every interface" (0.0.0.0) is not allowed,
///                 since then nobody could say which Host is right.
/// @returns whether it is of the loopback interface.
/// @throws InputError also where it is not and `allow_remote` is false.
bool check_server_address(const std::string& address, bool allow_remote);

/// Allowed Hosts of a request: "127.0.0.1:8080" and, on loopback, "localhost:8080".
std::vector<std::string> server_hosts(const std::string& address, bool loopback, int port);

/// A page with its nonce in place of the word NONCE: only scripts and styles that carry it run.
std::string page_with_nonce(std::string_view html, const std::string& nonce);

/// The Content-Security-Policy for that page.
std::string page_policy(const std::string& nonce);

}  // namespace haptrial::experiments
