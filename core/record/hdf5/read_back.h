#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "core/record/table/schema.h"

namespace haptrial::record {

/// A table and how many rows of it were written.
struct WrittenTable {
  const TableSchema* schema;
  std::uint64_t rows;
};

/// Opens a file that was just closed, and looks whether it holds what was written: another program
/// may have cut or overwritten it.
/// @param chunks  also read and inflate every chunk of rows, which their checksums judge
/// @returns what does not read back; empty if all does
std::string find_unreadable(const std::filesystem::path& file, std::span<const WrittenTable> tables,
                            bool chunks);

}  // namespace haptrial::record
