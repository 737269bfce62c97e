#include "core/record/table/field_codec.h"

#include <array>
#include <bit>
#include <span>
#include <string_view>

#include "core/record/table/schema.h"

namespace haptrial::record {
namespace {

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

std::string_view text_at(const Field& field, const std::uint8_t* member) {
  if (field.member == MemberType::kText) {
    return *reinterpret_cast<const std::string*>(member);
  }
  return field.member == MemberType::kName ? reinterpret_cast<const char*>(member)
                                           : field.words.word_of(*member);
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
    const EnumText::Entry* entry = field.words.find(word);
    if (entry == nullptr) {
      unknown(table, field, "the unknown word '" + word + "'", field.words.list());
    }
    members[i * stride] = entry->value;
  }
}

void get_names(const std::string& table, const Field& field, const BytePlanes& planes, Place from,
               std::uint8_t* members, std::size_t stride, std::size_t count) {
  const std::size_t bytes = field.column.bytes;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = get_text(planes, {from.offset, from.row + i}, bytes);
    if (name.size() >= bytes) {
      unknown(table, field, "the name '" + name + "'",
              "at most " + std::to_string(bytes - 1) + " bytes");
    }
    std::memset(members + i * stride, 0, bytes);
    std::memcpy(members + i * stride, name.data(), name.size());
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

}  // namespace

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
      put_text(planes, {to.offset, to.row + i}, text_at(field, member), column.bytes);
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

void get_field(const std::string& table, const Field& field, const BytePlanes& planes, Place from,
               std::uint8_t* members, std::size_t stride, std::size_t count) {
  const Column& column = field.column;
  if (column.type == ColumnType::kText && !field.words.empty()) {
    get_words(table, field, planes, from, members, stride, count);
  } else if (field.member == MemberType::kName) {
    get_names(table, field, planes, from, members, stride, count);
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

}  // namespace haptrial::record
