#pragma once

#include <cstddef>

#include "core/record/schema.h"

// Columns by their type, for the tables of schemas.
namespace haptrial::record::columns {

constexpr Column u8(const char* name, const char* description) {
  return {name, ColumnType::kU8, 1, "1", description};
}
constexpr Column i32(const char* name, const char* description) {
  return {name, ColumnType::kI32, 4, "1", description};
}
constexpr Column i64(const char* name, const char* unit, const char* description) {
  return {name, ColumnType::kI64, 8, unit, description};
}
constexpr Column u64(const char* name, const char* description) {
  return {name, ColumnType::kU64, 8, "1", description};
}
constexpr Column f32(const char* name, const char* unit, const char* description,
                     double resolution = 0.0) {
  return {name, ColumnType::kF32, 4, unit, description, resolution};
}
constexpr Column f64(const char* name, const char* unit, const char* description) {
  return {name, ColumnType::kF64, 8, unit, description};
}
constexpr Column text(const char* name, std::size_t bytes, const char* description) {
  return {name, ColumnType::kText, bytes, "", description};
}

}  // namespace haptrial::record::columns
