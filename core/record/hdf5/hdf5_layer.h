#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/record/hdf5/hdf5_handle.h"
#include "core/record/table/schema.h"

/// The part of HDF5 that session files need. Inside core/record only; hdf5.h stays in the source.
namespace haptrial::record::h5 {

/// Another program holds HDF5's lock on a file, as one that reads it without SWMR does.
class InUseError : public Error {
 public:
  using Error::Error;
};

/// Creates a file, readable by HDF5 1.10 and later.
/// @param over  the file may exist, and loses what it holds
Id create_file(const std::filesystem::path& path, bool over = false);
/// Opens a file for reading; also one whose writer was killed or still writes.
Id open_file(const std::filesystem::path& path);
/// Opens a file to go on writing, as after start_swmr(); also one whose writer was killed, which
/// must be certain: nothing here keeps two writers apart. @throws InUseError
Id open_to_go_on(const std::filesystem::path& path);
/// From here on HDF5 orders its writes so that the file is readable at every instant (single
/// writer, multiple readers). No object or attribute may be created after it.
void start_swmr(const Id& file);
void flush(const Id& file);
void close(Id& file);
/// The descriptor under an open file; it stays HDF5's.
int descriptor(const Id& file);

void put(const Id& object, const char* attribute, const std::string& value);
void put(const Id& object, const char* attribute, const std::vector<std::string>& values);
void put(const Id& object, const char* attribute, const std::vector<double>& values);
void put(const Id& object, const char* attribute, double value);
void put(const Id& object, const char* attribute, std::int64_t value);
void put(const Id& object, const char* attribute, std::uint64_t value);

std::string get_text(const Id& object, const char* attribute);
std::vector<std::string> get_texts(const Id& object, const char* attribute);
std::vector<double> get_numbers(const Id& object, const char* attribute);
double get_f64(const Id& object, const char* attribute);
std::int64_t get_i64(const Id& object, const char* attribute);
std::uint64_t get_u64(const Id& object, const char* attribute);
bool has_attribute(const Id& object, const char* attribute);

/// An empty extendible dataset with its columns, units and resolutions as attributes.
Id create_table(const Id& file, const TableSchema& schema);
/// @throws Error when it is missing or has other columns or filters than the schema.
/// @param chunk_rows  receives the chunk length of the file.
Id open_table(const Id& file, const TableSchema& schema, std::size_t& chunk_rows);

/// The same of a table whatever its columns are. @param row_bytes  receives the length of a row
Id open_table(const Id& file, const std::string& name, std::size_t& row_bytes,
              std::size_t& chunk_rows);

bool has_table(const Id& file, const char* name);
std::vector<std::string> table_names(const Id& file);
std::uint64_t row_count(const Id& table);
void set_row_count(const Id& table, std::uint64_t rows);
/// A chunk that went through the filters already. @param row  its first row.
void write_chunk(const Id& table, std::uint64_t row, std::span<const std::uint8_t> bytes);
std::vector<std::uint8_t> read_chunk(const Id& table, std::uint64_t row);

}  // namespace haptrial::record::h5
