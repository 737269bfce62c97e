#include "core/scene/read/read_field.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "core/scene/read/field_kinds.h"

namespace haptrial::scene {
namespace {

/// Null, with the problem noted, if the type is not known.
const KindOfField* kind_of(Table& table) {
  table.describe({"type", "Kind of the field: the law of its force", "", true});
  std::vector<std::string> words;
  for (const KindOfField& kind : kinds_of_field()) {
    words.push_back(kind.word);
  }
  const std::string word = table.choice("type", words);
  if (table.whole_text("type") != word) {
    for (const std::string& key : table.keys()) {
      table.leave(key);  // what it means is not known
    }
    return nullptr;
  }
  return &*std::ranges::find(kinds_of_field(), word, &KindOfField::word);
}

}  // namespace

Field read_field(Table& table, std::string name, double rate,
                 const std::vector<std::string>& values) {
  Field field;
  field.name = std::move(name);
  const KindOfField* kind = kind_of(table);
  if (kind == nullptr) {
    return field;
  }
  if (kind->has_limit) {
    field_limit_schema().read(table, field);
  }
  field.fade_in = field.fade_out = kind->fade;
  field_fade_schema().read(table, field);
  field.kind = kind->read(table, {rate, field.limit, values});
  return field;
}

std::vector<Field> read_fields(Table& fields, double rate, const std::vector<Field>& objects,
                               const std::vector<std::string>& values) {
  std::vector<Field> found;
  std::vector<Table> tables;
  for (const std::string& name : fields.keys()) {
    tables.push_back(fields.table(name));
    found.push_back(read_field(tables.back(), name, rate, values));
  }
  std::vector<std::string> surfaces;
  for (const std::vector<Field>* some : {&std::as_const(found), &objects}) {
    for (const Field& field : *some) {
      if (traits_of(field).surface) {
        surfaces.push_back(field.name);
      }
    }
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::string& on = surface_of(found[i]);
    if (on.empty() || std::find(surfaces.begin(), surfaces.end(), on) != surfaces.end()) {
      continue;
    }
    if (surfaces.empty()) {
      tables[i].reject("on", fmt::format("is \"{}\", but the definition has no wall, box, sphere "
                                         "or cylinder; add one",
                                         on));
    } else {
      tables[i].reject("on", fmt::format("\"{}\"", on),
                       fmt::format("{}", fmt::join(surfaces, ", ")));
    }
  }
  return found;
}

}  // namespace haptrial::scene
