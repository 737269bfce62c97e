#pragma once

#include <filesystem>
#include <string>

#include "core/device/certificate.h"

namespace haptrial::protocols {

/// Key figures of a certificate that `haptrial device-test --certificate` wrote.
/// @throws InputError if the file cannot be read or is no certificate
device::Certificate read_certificate(const std::filesystem::path& file);

/// The table [certificate] with these figures, and those of rotation and grip, as text of a
/// definition that ends in a newline.
std::string certificate_table(const device::Certificate& certificate);

}  // namespace haptrial::protocols
