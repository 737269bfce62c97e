#include "core/record/table_description.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <set>
#include <stdexcept>
#include <string_view>

#include "core/record/packed_row.h"
#include "core/record/rounding.h"

namespace haptrial::record {
namespace {

// Rows are split in batches that stay in the first-level cache.
constexpr std::size_t kBatch = 256;

/// A member of row i, from the address of the member in row 0.
template <class T>
T value_at(const std::uint8_t* members, std::size_t stride, std::size_t i) {
  T value;
  std::memcpy(&value, members + i * stride, sizeof(T));
  return value;
}

/// One column of a batch; `planes` has it at byte `offset`.
struct Place {
  std::size_t offset;
  std::size_t row;
};

template <class Bits>
void put_bits(BytePlanes& planes, Place to, const std::uint8_t* members, std::size_t stride,
              std::size_t count) {
  std::array<Bits, kBatch> values;
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = value_at<Bits>(members, stride, i);
  }
  planes.put_column<Bits>(to.offset, to.row, std::span<const Bits>(values.data(), count));
}

void put_rounded(BytePlanes& planes, Place to, const std::uint8_t* members, std::size_t stride,
                 std::size_t count, double resolution) {
  std::array<double, kBatch> values;
  std::array<std::uint32_t, kBatch> bits;
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = value_at<double>(members, stride, i);
  }
  if (resolution > 0.0) {
    for (std::size_t i = 0; i < count; ++i) {
      values[i] = on_grid(values[i], resolution);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    bits[i] = std::bit_cast<std::uint32_t>(static_cast<float>(values[i]));
  }
  planes.put_column<std::uint32_t>(to.offset, to.row,
                                   std::span<const std::uint32_t>(bits.data(), count));
}

void put_text(BytePlanes& planes, Place to, std::string_view text, std::size_t bytes) {
  for (std::size_t b = 0; b < bytes; ++b) {
    const auto byte = b < text.size() ? static_cast<std::uint8_t>(text[b]) : std::uint8_t{0};
    planes.data()[(to.offset + b) * planes.capacity() + to.row] = byte;
  }
}

std::string get_text(const BytePlanes& planes, Place from, std::size_t bytes) {
  std::string text;
  for (std::size_t b = 0; b < bytes; ++b) {
    const std::uint8_t byte = planes.bytes()[(from.offset + b) * planes.capacity() + from.row];
    if (byte == 0) {
      break;
    }
    text += static_cast<char>(byte);
  }
  return text;
}

void put_field(const Field& field, BytePlanes& planes, Place to, const std::uint8_t* members,
               std::size_t stride, std::size_t count) {
  const Column& column = field.column;
  if (column.type == ColumnType::kText) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint8_t* member = members + i * stride;
      const std::string_view text = field.words.empty()
                                        ? *reinterpret_cast<const std::string*>(member)
                                        : std::string_view(field.words.word_of(*member));
      put_text(planes, {to.offset, to.row + i}, text, column.bytes);
    }
  } else if (column.type == ColumnType::kF32 && field.member == MemberType::kF64) {
    put_rounded(planes, to, members, stride, count, column.resolution);
  } else if (column.bytes == 8) {
    put_bits<std::uint64_t>(planes, to, members, stride, count);
  } else if (column.bytes == 4) {
    put_bits<std::uint32_t>(planes, to, members, stride, count);
  } else {
    put_bits<std::uint8_t>(planes, to, members, stride, count);
  }
}

template <class Bits>
void get_bits(const BytePlanes& planes, Place from, std::uint8_t* members, std::size_t stride,
              std::size_t count) {
  std::array<Bits, kBatch> values;
  planes.get_column<Bits>(from.offset, from.row, std::span<Bits>(values.data(), count));
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(members + i * stride, &values[i], sizeof(Bits));
  }
}

void get_real32(const BytePlanes& planes, Place from, std::uint8_t* members, std::size_t stride,
                std::size_t count) {
  std::array<std::uint32_t, kBatch> bits;
  planes.get_column<std::uint32_t>(from.offset, from.row,
                                   std::span<std::uint32_t>(bits.data(), count));
  for (std::size_t i = 0; i < count; ++i) {
    const double value = static_cast<double>(std::bit_cast<float>(bits[i]));
    std::memcpy(members + i * stride, &value, sizeof(value));
  }
}

[[noreturn]] void unknown(const std::string& table, const Field& field, const std::string& found,
                          const std::string& allowed) {
  throw UnknownWord("the column " + std::string(field.column.name) + " of /" + table + " has " +
                    found + "; allowed: " + allowed);
}

void get_words(const std::string& table, const Field& field, const BytePlanes& planes, Place from,
               std::uint8_t* members, std::size_t stride, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::string word = get_text(planes, {from.offset, from.row + i}, field.column.bytes);
    const Words::Entry* entry = field.words.find(word);
    if (entry == nullptr) {
      unknown(table, field, "the unknown word '" + word + "'", field.words.list());
    }
    members[i * stride] = entry->value;
  }
}

void get_small(const std::string& table, const Field& field, const BytePlanes& planes, Place from,
               std::uint8_t* members, std::size_t stride, std::size_t count) {
  std::array<std::uint8_t, kBatch> values;
  planes.get_column<std::uint8_t>(from.offset, from.row,
                                  std::span<std::uint8_t>(values.data(), count));
  const bool truth = field.member == MemberType::kBool;
  std::array<bool, 256> known;
  for (std::size_t v = 0; v < known.size(); ++v) {
    known[v] = field.words.empty() || field.words.has(static_cast<std::uint8_t>(v));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!known[values[i]]) {
      unknown(table, field, "the unknown number " + std::to_string(values[i]),
              field.words.numbered());
    }
    members[i * stride] = truth ? static_cast<std::uint8_t>(values[i] != 0) : values[i];
  }
}

void get_field(const std::string& table, const Field& field, const BytePlanes& planes, Place from,
               std::uint8_t* members, std::size_t stride, std::size_t count) {
  const Column& column = field.column;
  if (column.type == ColumnType::kText && !field.words.empty()) {
    get_words(table, field, planes, from, members, stride, count);
  } else if (column.type == ColumnType::kText) {
    for (std::size_t i = 0; i < count; ++i) {
      *reinterpret_cast<std::string*>(members + i * stride) =
          get_text(planes, {from.offset, from.row + i}, column.bytes);
    }
  } else if (column.type == ColumnType::kF32 && field.member == MemberType::kF64) {
    get_real32(planes, from, members, stride, count);
  } else if (column.bytes == 8) {
    get_bits<std::uint64_t>(planes, from, members, stride, count);
  } else if (column.bytes == 4) {
    get_bits<std::uint32_t>(planes, from, members, stride, count);
  } else {
    get_small(table, field, planes, from, members, stride, count);
  }
}

void check_words(const std::string& table, const Field& field) {
  for (const Words::Entry& entry : field.words.entries()) {
    if (field.column.type == ColumnType::kText &&
        std::string_view(entry.word).size() > field.column.bytes) {
      throw std::invalid_argument("the word " + std::string(entry.word) + " does not fit " +
                                  field.column.name + " of /" + table);
    }
  }
}

}  // namespace

TableDescription::TableDescription(TableHead head, std::vector<std::vector<Field>> fields,
                                   std::size_t row_size, Convert convert)
    : head_(std::move(head)), name_(head_.name), row_size_(row_size), convert_(convert) {
  std::set<std::string_view> names;
  std::set<std::int64_t, std::greater<>> versions{head_.since};
  for (std::vector<Field>& part : fields) {
    for (Field& field : part) {
      if (!names.insert(field.column.name).second) {
        throw std::invalid_argument("/" + name_ + " has two columns " + field.column.name);
      }
      versions.insert(std::max(field.since, head_.since));
      check_words(name_, field);
      fields_.push_back(std::move(field));
    }
  }
  for (const std::int64_t version : versions) {
    auto layout = std::make_shared<Layout>();
    layout->since = version;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (fields_[i].since > version) {
        continue;
      }
      layout->fields.push_back(i);
      layout->columns.push_back(fields_[i].column);
    }
    layout->schema = {head_.name, head_.description, head_.chunk_rows, layout->columns};
    layouts_.push_back(std::move(layout));
  }
  std::vector<const char*> needed = head_.order;
  if (head_.of == RowsOf::kTick || head_.of == RowsOf::kEachTick) {
    needed.push_back("sequence");
  } else if (head_.of == RowsOf::kEndedPass) {
    needed.push_back("pass");
  }
  for (const char* column : needed) {
    schema().offset(column);  // throws where there is none
  }
}

const TableDescription::Layout& TableDescription::layout(std::int64_t version) const {
  for (const auto& layout : layouts_) {
    if (layout->since <= version) {
      return *layout;
    }
  }
  return *layouts_.back();
}

const TableSchema& TableDescription::schema(std::int64_t version) const {
  return layout(version).schema;
}

std::vector<std::int64_t> TableDescription::versions() const {
  std::vector<std::int64_t> all;
  for (const auto& layout : layouts_) {
    all.push_back(layout->since);
  }
  return all;
}

void TableDescription::check(const Field& field, const std::uint8_t* rows,
                             std::size_t count) const {
  if (field.member != MemberType::kText && field.words.empty()) {
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* member = rows + i * row_size_ + field.offset;
    if (field.member == MemberType::kText) {
      check_text(*reinterpret_cast<const std::string*>(member), field.column.bytes,
                 field.column.name);
    } else if (!field.words.has(*member)) {
      throw std::invalid_argument(std::string(field.column.name) + " of /" + name_ +
                                  ": no word for " + std::to_string(*member));
    }
  }
}

void TableDescription::put(BytePlanes& planes, std::size_t at, const void* rows,
                           std::size_t count) const {
  const auto* bytes = static_cast<const std::uint8_t*>(rows);
  for (const Field& field : fields_) {
    check(field, bytes, count);
  }
  for (std::size_t done = 0; done < count; done += kBatch) {
    const std::size_t batch = std::min(kBatch, count - done);
    Place to{0, at + done};
    for (const Field& field : fields_) {
      put_field(field, planes, to, bytes + done * row_size_ + field.offset, row_size_, batch);
      to.offset += field.column.bytes;
    }
  }
}

void TableDescription::get(const BytePlanes& planes, std::size_t at, void* rows, std::size_t count,
                           std::int64_t version) const {
  auto* bytes = static_cast<std::uint8_t*>(rows);
  const Layout& from_layout = layout(version);
  for (std::size_t done = 0; done < count; done += kBatch) {
    const std::size_t batch = std::min(kBatch, count - done);
    Place from{0, at + done};
    for (const std::size_t i : from_layout.fields) {
      const Field& field = fields_[i];
      get_field(name_, field, planes, from, bytes + done * row_size_ + field.offset, row_size_,
                batch);
      from.offset += field.column.bytes;
    }
  }
  for (std::size_t i = 0; complete_ && &from_layout != layouts_.front().get() && i < count; ++i) {
    complete_(bytes + i * row_size_);
  }
}

bool TableDescription::fits(const BytePlanes& planes, std::size_t count,
                            std::int64_t version) const {
  std::size_t offset = 0;
  for (const std::size_t i : layout(version).fields) {
    const Field& field = fields_[i];
    for (std::size_t row = 0; !field.words.empty() && row < count; ++row) {
      const bool known =
          field.column.type == ColumnType::kText
              ? field.words.find(get_text(planes, {offset, row}, field.column.bytes)) != nullptr
              : field.words.has(planes.bytes()[offset * planes.capacity() + row]);
      if (!known) {
        return false;
      }
    }
    offset += field.column.bytes;
  }
  return true;
}

std::vector<std::uint8_t> TableDescription::packed(const BytePlanes& planes, std::size_t count,
                                                   std::int64_t version) const {
  const std::size_t bytes = schema().row_bytes();
  BytePlanes present(bytes, count);
  const bool is_present = &layout(version) == layouts_.front().get();
  if (!is_present) {
    convert_(*this, planes, count, version, present);
  }
  std::vector<std::uint8_t> rows(bytes * count);
  for (std::size_t i = 0; i < count; ++i) {
    (is_present ? planes : present).get_row(i, std::span(rows).subspan(i * bytes, bytes));
  }
  return rows;
}

std::int64_t TableDescription::integer(const std::uint8_t* row, const char* column,
                                       std::int64_t version) const {
  for (const std::size_t i : layout(version).fields) {
    const Field& field = fields_[i];
    if (std::string_view(column) != field.column.name) {
      row += field.column.bytes;
    } else if (field.column.bytes == 8) {
      return value_at<std::int64_t>(row, 0, 0);
    } else if (field.column.bytes == 4) {
      return value_at<std::int32_t>(row, 0, 0);
    } else {
      return *row;
    }
  }
  throw std::invalid_argument("no column " + std::string(column) + " in /" + name_);
}

std::vector<std::int64_t> TableDescription::key(const std::uint8_t* row) const {
  std::vector<std::int64_t> key;
  for (const char* column : head_.order) {
    key.push_back(integer(row, column));
  }
  return key;
}

Field number_field(const char* name, std::size_t offset, MemberType type, const char* unit,
                   const char* description) {
  const auto field = [&](ColumnType column, std::size_t bytes) -> Field {
    return {{name, column, bytes, unit, description}, offset, type};
  };
  switch (type) {
    case MemberType::kI32:
    case MemberType::kU32:
      return field(ColumnType::kI32, 4);
    case MemberType::kI64:
      return field(ColumnType::kI64, 8);
    case MemberType::kU64:
      return field(ColumnType::kU64, 8);
    case MemberType::kF32:
      return field(ColumnType::kF32, 4);
    case MemberType::kF64:
      return field(ColumnType::kF64, 8);
    case MemberType::kBool:
    case MemberType::kU8:
    case MemberType::kText:
      break;
  }
  return field(ColumnType::kU8, 1);
}

Field real32_field(const char* name, std::size_t offset, const char* unit, const char* description,
                   double resolution) {
  return {{name, ColumnType::kF32, 4, unit, description, resolution}, offset, MemberType::kF64};
}

Field text_field(const char* name, std::size_t offset, std::size_t bytes, const char* description) {
  return {{name, ColumnType::kText, bytes, "", description}, offset, MemberType::kText};
}

Field word_field(const char* name, std::size_t offset, std::size_t bytes, Words words,
                 const char* description) {
  return {
      {name, ColumnType::kText, bytes, "", description}, offset, MemberType::kU8, std::move(words)};
}

Field code_field(const char* name, std::size_t offset, Words words, const char* description) {
  return {{name, ColumnType::kU8, 1, "1", description}, offset, MemberType::kU8, std::move(words)};
}

}  // namespace haptrial::record
