#pragma once

#include <array>
#include <functional>
#include <initializer_list>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/record/table/table_description.h"

namespace haptrial::record {

/// Describes a table whose rows are of the type Row, which is default-constructible:
///
///     const Table<AnswerRow>& answers() {
///       using T = Table<AnswerRow>;
///       static const T table({"answers", "one row an answer", 64, RowsOf::kSession, {"pass"}},
///                            {T::column("pass", &AnswerRow::pass, "1", "row of /trials"),
///                             T::rounded("force", &AnswerRow::force, "N", "...", 0x1p-13),
///                             T::text("comment", &AnswerRow::comment, 256, "...")});
///       return table;
///     }
///
/// A member is a pointer to one, or a function that gives a reference into a row. Names and
/// descriptions are literals. Columns of the file: bool and std::uint8_t u8, 32-bit integers i32,
/// 64-bit ones i64 or u64, float f32, double f64.
template <class Row>
class Table : public TableDescription {
 public:
  using Columns = std::vector<Field>;

  Table(TableHead head, std::initializer_list<Columns> columns)
      : TableDescription(std::move(head), columns, sizeof(Row), &Table::repack) {}
  /// @param complete  fills what no column says, or what files of older versions say in another
  /// way; called with the file's schema version for each row that was read
  Table(TableHead head, std::initializer_list<Columns> columns,
        void (*complete)(Row&, std::int64_t version))
      : Table(std::move(head), columns) {
    complete_ = [complete](void* row, std::int64_t version) {
      complete(*static_cast<Row*>(row), version);
    };
  }

  template <class Member>
  static Columns column(const char* name, Member member, const char* unit,
                        const char* description) {
    using T = std::remove_cvref_t<std::invoke_result_t<Member, Row&>>;
    return {number_field(name, offset_of(member), member_type<T>(), unit, description)};
  }
  /// A double that the file has as f32. @param resolution  of which the file has multiples; 0: as
  /// given
  template <class Member>
  static Columns rounded(const char* name, Member member, const char* unit, const char* description,
                         double resolution = 0.0) {
    return {real32_field(name, offset_of(member), unit, description, resolution)};
  }
  /// A std::string. @param bytes  the most that it may have in UTF-8
  template <class Member>
  static Columns text(const char* name, Member member, std::size_t bytes, const char* description) {
    return {text_field(name, offset_of(member), bytes, description)};
  }
  /// A name of fixed length, such as a Phase: as many characters as the column, the last one 0.
  template <class Member>
  static Columns name(const char* column_name, Member member, const char* description) {
    using T = std::remove_cvref_t<std::invoke_result_t<Member, Row&>>;
    static_assert(std::is_trivially_copyable_v<T>);
    return {name_field(column_name, offset_of(member), sizeof(T), description)};
  }
  /// An enumeration as a word.
  template <class Member>
  static Columns word(const char* name, Member member, std::size_t bytes, EnumText words,
                      const char* description) {
    static_assert(sizeof(std::invoke_result_t<Member, Row&>) == 1);
    return {word_field(name, offset_of(member), bytes, std::move(words), description)};
  }
  /// An enumeration as a number.
  template <class Member>
  static Columns code(const char* name, Member member, EnumText words, const char* description) {
    static_assert(sizeof(std::invoke_result_t<Member, Row&>) == 1);
    return {code_field(name, offset_of(member), std::move(words), description)};
  }
  /// The elements of an array or vector, from element 0 on.
  template <std::size_t N, class Member>
  static Columns elements(const std::array<const char*, N>& names, Member member, const char* unit,
                          const std::array<const char*, N>& descriptions) {
    using T = std::remove_cvref_t<decltype(std::declval<std::invoke_result_t<Member, Row&>>()[0])>;
    Columns columns;
    for (std::size_t i = 0; i < N; ++i) {
      columns.push_back(number_field(names[i], offset_of(member) + i * sizeof(T), member_type<T>(),
                                     unit, descriptions[i]));
    }
    return columns;
  }
  template <std::size_t N, class Member>
  static Columns elements(const std::array<const char*, N>& names, Member member, const char* unit,
                          const char* description) {
    std::array<const char*, N> all;
    all.fill(description);
    return elements(names, member, unit, all);
  }
  template <std::size_t N, class Member>
  static Columns rounded_elements(const std::array<const char*, N>& names, Member member,
                                  const char* unit, const std::array<const char*, N>& descriptions,
                                  double resolution = 0.0) {
    Columns columns;
    for (std::size_t i = 0; i < N; ++i) {
      columns.push_back(real32_field(names[i], offset_of(member) + i * sizeof(double), unit,
                                     descriptions[i], resolution));
    }
    return columns;
  }
  template <std::size_t N, class Member>
  static Columns rounded_elements(const std::array<const char*, N>& names, Member member,
                                  const char* unit, const char* description,
                                  double resolution = 0.0) {
    std::array<const char*, N> all;
    all.fill(description);
    return rounded_elements(names, member, unit, all, resolution);
  }
  /// Columns that files have only from a schema version on.
  static Columns since(std::int64_t version, Columns columns) {
    for (Field& field : columns) {
      field.since = version;
    }
    return columns;
  }

  std::vector<Row> rows(const BytePlanes& planes, std::size_t count,
                        std::int64_t version = kSchemaVersion) const {
    std::vector<Row> result(count);
    get(planes, 0, result.data(), count, version);
    return result;
  }

 private:
  template <class Member>
  static std::size_t offset_of(Member member) {
    Row row{};
    auto& value = std::invoke(member, row);
    return static_cast<std::size_t>(reinterpret_cast<const std::uint8_t*>(&value) -
                                    reinterpret_cast<const std::uint8_t*>(&row));
  }
  template <class T>
  static constexpr MemberType member_type() {
    if constexpr (std::is_same_v<T, bool>) {
      return MemberType::kBool;
    } else if constexpr (std::is_same_v<T, std::uint8_t>) {
      return MemberType::kU8;
    } else if constexpr (std::is_same_v<T, std::int32_t>) {
      return MemberType::kI32;
    } else if constexpr (std::is_same_v<T, std::uint32_t>) {
      return MemberType::kU32;
    } else if constexpr (std::is_same_v<T, std::int64_t>) {
      return MemberType::kI64;
    } else if constexpr (std::is_same_v<T, std::uint64_t>) {
      return MemberType::kU64;
    } else if constexpr (std::is_same_v<T, float>) {
      return MemberType::kF32;
    } else {
      static_assert(std::is_same_v<T, double>, "no column for a member of this type");
      return MemberType::kF64;
    }
  }
  static void repack(const TableDescription& table, const BytePlanes& planes, std::size_t count,
                     std::int64_t version, BytePlanes& present) {
    std::vector<Row> rows(count);
    table.get(planes, 0, rows.data(), count, version);
    table.put(present, 0, rows.data(), count);
  }
};

/// The table of a row type: a specialisation beside each type that is written or read by it.
template <class Row>
const Table<Row>& table_of();

}  // namespace haptrial::record
