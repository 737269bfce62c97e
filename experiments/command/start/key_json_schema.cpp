#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "experiments/command/start/key_list.h"

namespace haptrial::experiments {
namespace {

using Json = nlohmann::ordered_json;

Json number(const char* type, const Bounds& bounds) {
  Json json{{"type", type}};
  if (std::isfinite(bounds.low)) {
    json[bounds.open_low ? "exclusiveMinimum" : "minimum"] = bounds.low;
  }
  if (std::isfinite(bounds.high)) {
    json["maximum"] = bounds.high;
  }
  return json;
}

Json list_of(Json entry) { return {{"type", "array"}, {"items", std::move(entry)}}; }

/// Texts stand for numbers also within lists.
Json schema_of(const KeyForm& form, bool or_text) {
  const Json text{{"type", "string"}, {"minLength", 1}};
  if (form.type == "number") {
    return number("number", form.bounds);
  }
  if (form.type == "whole number") {
    return number("integer", form.bounds);
  }
  if (form.type == "true or false") {
    return {{"type", "boolean"}};
  }
  if (form.type == "text") {
    return text;
  }
  if (form.type == "choice") {  // NAME: words that the definition itself chooses
    const bool own = std::find(form.words.begin(), form.words.end(), "NAME") != form.words.end();
    return own ? text : Json{{"enum", form.words}};
  }
  if (form.type == "list of numbers") {
    Json entry = number("number", form.bounds);
    return list_of(or_text ? Json{{"anyOf", {entry, text}}} : entry);
  }
  if (form.type == "list of texts") {
    return list_of(text);
  }
  return {{"type", form.type == "list" ? "array" : "object"}};
}

std::string description_of(const KnownKey& key) {
  std::string words = key.words;
  words += key.unit.empty() ? "" : fmt::format(" [{}]", key.unit);
  words += key.allowed.empty() ? "" : fmt::format("\nAllowed: {}", key.allowed);
  words += key.otherwise.empty() ? "" : fmt::format("\nIf left out: {}", key.otherwise);
  words += key.when.empty() ? "" : fmt::format("\nOnly with {}", fmt::join(key.when, "; "));
  return words;
}

/// A place in a definition: a key, a table, or both, if a key may be either.
struct Place {
  std::vector<Json> values;               // schemas of what may stand there beside a table
  std::string description;                // of the key
  std::map<std::string, Place> members;   // of a table, by name; NAME: any other name
  std::map<std::string, Place> elements;  // the same of each table of an array
};

Place& place_at(Place& root, const std::string& path) {
  Place* place = &root;
  std::istringstream parts(path);
  bool in_array = false;
  for (std::string part; std::getline(parts, part, '.');) {
    auto& inner = in_array ? place->elements : place->members;
    in_array = part.ends_with("[]");
    place = &inner[in_array ? part.substr(0, part.size() - 2) : part];
  }
  return *place;
}

Json alternatives(const Place& place);

Json table_of(const std::map<std::string, Place>& members) {
  Json json{{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}};
  for (const auto& [name, member] : members) {
    if (name == "NAME") {
      json["additionalProperties"] = alternatives(member);
      continue;
    }
    json["properties"][name] = alternatives(member);
  }
  return json;
}

Json alternatives(const Place& place) {
  std::vector<Json> all = place.values;
  if (!place.members.empty()) {
    all.push_back(table_of(place.members));
  }
  if (!place.elements.empty()) {
    all.push_back(list_of(table_of(place.elements)));
  }
  Json json = all.size() == 1 ? all.front() : Json{{"anyOf", all}};
  if (!place.description.empty()) {
    json["description"] = place.description;
  }
  return json;
}

void add_key(Place& root, const KnownKey& key) {
  Place& place = place_at(root, key.path());
  const bool or_text = std::any_of(key.forms.begin(), key.forms.end(),
                                   [](const KeyForm& form) { return form.type == "text"; });
  for (const KeyForm& form : key.forms) {
    place.values.push_back(schema_of(form, or_text));
  }
  place.description = description_of(key);
}

/// "procedures[]" with the keys of "procedure"
void add_shared(Place& root, const std::string& table, const std::string& own) {
  const Json reference{{"$ref", "#/properties/" + own}};
  const bool array = table.ends_with("[]");
  place_at(root, table).values.push_back(array ? list_of(reference) : reference);
}

}  // namespace

std::string key_json_schema(const std::vector<KnownKey>& keys, std::string_view protocol) {
  Place root;
  for (const KnownKey& key : keys) {
    add_key(root, key);
  }
  for (const auto& [table, own] : shared_tables()) {
    const bool within_another = table.find("[].") != std::string::npos;  // which refers already
    if (root.members.contains(own) && !within_another) {
      add_shared(root, table, own);
    }
  }
  Json json{{"$schema", "http://json-schema.org/draft-07/schema#"},
            {"title", fmt::format("haptrial: protocol = \"{}\"", protocol)}};
  json.update(table_of(root.members));
  constexpr int kIndent = 1;
  return json.dump(kIndent);
}

}  // namespace haptrial::experiments
