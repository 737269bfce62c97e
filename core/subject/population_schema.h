#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/schema.h"
#include "core/subject/population.h"

namespace haptrial::subject {

/// A key that states a parameter: `key = M`, the same for everybody, or
/// `key = { median = M, spread = S }` (population.h).
template <class Person>
struct PersonKey {
  const char* name;
  double Person::*member;
  Bounds bounds;  // of the median; no person has more
  const char* unit;
  const char* description;
  bool shifted{false};
  const char* stream{nullptr};  // null: the prefix of all streams and the name
};

/// The schema of a table of such keys, which are either all required or all optional.
/// @param streams  prefix of the streams' names
template <class Person>
Schema<Population<Person>> make_population_schema(std::string_view streams, bool required,
                                                  const std::vector<PersonKey<Person>>& keys) {
  Schema<Population<Person>> schema;
  for (const PersonKey<Person>& key : keys) {
    const std::string stream = key.stream != nullptr ? key.stream : std::string(streams) + key.name;
    if (!required) {
      schema.check([key](Table& table, Population<Person>&) {
        table.otherwise(key.name, Person{}.*key.member);
      });
    }
    schema.custom(key.name, key.description,
                  [key, stream](Table& table, const std::string& name, Population<Person>& people) {
                    const Variation variation =
                        key.shifted ? read_shift(table, name, key.bounds, key.unit)
                                    : read_variation(table, name, key.bounds, key.unit);
                    const Bounds most{key.shifted ? key.bounds.low : 0.0, key.bounds.high};
                    people.everybody.*key.member = variation.median;
                    people.varying.push_back({key.member, variation, most, stream});
                  });
    if (required) {
      schema.required();
    }
  }
  return schema;
}

}  // namespace haptrial::subject
