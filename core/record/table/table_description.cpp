#include "core/record/table/table_description.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string_view>

#include "core/record/table/field_codec.h"

namespace haptrial::record {
namespace {

void check_words(const std::string& table, const Field& field) {
  for (const EnumText::Entry& entry : field.words.entries()) {
    if (field.column.type == ColumnType::kText &&
        std::string_view(entry.word).size() > field.column.bytes) {
      throw std::invalid_argument("the word " + std::string(entry.word) + " does not fit " +
                                  field.column.name + " of /" + table);
    }
  }
}

bool may_hold(const Field& field, const BytePlanes& planes, Place at) {
  if (field.column.type != ColumnType::kText) {
    return field.words.has(planes.bytes()[at.offset * planes.capacity() + at.row]);
  }
  const std::string text = get_text(planes, at, field.column.bytes);
  return field.member == MemberType::kName ? !text.empty() && text.size() < field.column.bytes
                                           : field.words.find(text) != nullptr;
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
  } else if (head_.of == RowsOf::kEndedPass || head_.of == RowsOf::kPass) {
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
  for (std::size_t i = 0; complete_ && i < count; ++i) {
    complete_(bytes + i * row_size_, version);
  }
}

bool TableDescription::fits(const BytePlanes& planes, std::size_t count,
                            std::int64_t version) const {
  std::size_t offset = 0;
  for (const std::size_t i : layout(version).fields) {
    const Field& field = fields_[i];
    const bool checked = !field.words.empty() || field.member == MemberType::kName;
    for (std::size_t row = 0; checked && row < count; ++row) {
      if (!may_hold(field, planes, {offset, row})) {
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

void TableDescription::unpack(const std::vector<std::uint8_t>& packed, void* rows) const {
  const std::size_t bytes = schema().row_bytes();
  const std::size_t count = packed.size() / bytes;
  BytePlanes planes(bytes, count);
  for (std::size_t i = 0; i < count; ++i) {
    planes.put_row(i, std::span(packed).subspan(i * bytes, bytes));
  }
  get(planes, 0, rows, count);
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

}  // namespace haptrial::record
