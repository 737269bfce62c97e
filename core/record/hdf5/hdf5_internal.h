#pragma once

#include <hdf5.h>

#include <string>

#include "core/record/hdf5/hdf5_handle.h"

/// Declarations that the sources of hdf5_layer.h share; for those only.
namespace haptrial::record::h5 {

static_assert(sizeof(hid_t) == sizeof(std::int64_t));

/// The innermost entry of HDF5's error stack; of a system error, only its own words.
std::string reason();
[[noreturn]] void fail(const std::string& what);
/// @throws Error with what and reason() for an invalid identifier or a negative status.
Id take(hid_t id, const std::string& what);
void check(herr_t status, const std::string& what);

}  // namespace haptrial::record::h5
