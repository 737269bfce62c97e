#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "core/base/definition/schema.h"
#include "core/bone/curriculum/curriculum.h"

namespace haptrial::bone {
namespace {

constexpr const char* kForm =
    "texts as \"cavity_removed_percent >= 80\" or \"injured_voxels <= 0\"";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string_view::npos
             ? std::string_view()
             : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::optional<Criterion> parsed(std::string_view text) {
  for (const bool least : {true, false}) {
    const auto at = text.find(least ? ">=" : "<=");
    if (at == std::string_view::npos) {
      continue;
    }
    Criterion found{std::string(trimmed(text.substr(0, at))), least, 0.0};
    const std::string_view number = trimmed(text.substr(at + 2));
    const auto end = std::from_chars(number.data(), number.data() + number.size(), found.value);
    const bool good = end.ec == std::errc() && end.ptr == number.data() + number.size();
    return good && std::isfinite(found.value) && !found.quantity.empty() ? std::optional(found)
                                                                         : std::nullopt;
  }
  return std::nullopt;
}

const Schema<CurriculumCase>& case_schema() {
  using C = CurriculumCase;
  static const auto schema =
      Schema<C>()
          .text("name", &C::name, "Name of the case")
          .required()
          .text("bone", &C::bone, "Bone of the case, one of bone.bones")
          .otherwise("the first of bone.bones")
          .custom("pass",
                  "What a procedure must reach to pass, all of it: quantities of metrics.csv "
                  "without their units, or score, at least (>=) or at most (<=) so much",
                  [](Table& table, const std::string& key, C& c) {
                    for (const std::string& text : table.texts(key)) {
                      if (const auto criterion = parsed(text)) {
                        c.pass.push_back(*criterion);
                      } else {
                        table.reject(key, fmt::format("an array with \"{}\"", text), kForm);
                      }
                    }
                  })
          .required()
          .integer("in_a_row", &C::in_a_row, 1, 100,
                   "Procedures that must pass, one after the other, until the next case comes")
          .text("repeat", &C::repeat, "Earlier case that comes again after too many that failed")
          .otherwise("none")
          .integer("after", &C::after, 1, 100,
                   "Procedures in a row that fail, until the case of repeat comes again");
  return schema;
}

void check_case(Table& table, CurriculumCase& own, const std::vector<std::string>& bones,
                std::set<std::string>& names) {
  if (own.bone.empty() && !bones.empty()) {
    own.bone = bones.front();
  }
  if (std::ranges::find(bones, own.bone) == bones.end()) {
    table.reject("bone", fmt::format("\"{}\"", own.bone),
                 fmt::format("one of bone.bones: {}", fmt::join(bones, ", ")));
  }
  if (!own.repeat.empty() && !names.contains(own.repeat)) {
    table.reject("repeat", fmt::format("\"{}\"", own.repeat),
                 names.empty() ? "nothing: the first case has none before it"
                               : fmt::format("an earlier case: {}", fmt::join(names, ", ")));
  }
  if (own.name.empty() || own.name.find(',') != std::string::npos ||
      !names.insert(own.name).second) {
    table.reject("name", fmt::format("\"{}\"", own.name), "a name of its own without a comma");
  }
}

}  // namespace

Curriculum read_curriculum(Table& table, const std::vector<std::string>& bones) {
  Curriculum curriculum;
  std::set<std::string> names;
  for (Table& each : table.tables("cases")) {
    CurriculumCase& own = curriculum.cases.emplace_back(case_schema().read(each));
    check_case(each, own, bones, names);
  }
  return curriculum;
}

}  // namespace haptrial::bone
