#include "core/bone/data/label_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>

#include "core/base/definition/table.h"
#include "core/bone/data/anatomy.h"

namespace haptrial::bone {
namespace {

/// 1 to 255, or nothing.
std::optional<std::size_t> label_in(std::string_view digits) {
  std::size_t label = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), label);
  const bool whole = error == std::errc() && end == digits.data() + digits.size();
  return whole && label >= 1 && label <= 255 ? std::optional(label) : std::nullopt;
}

void put(std::vector<Structure>& structures, std::size_t label, Structure structure) {
  if (structures.size() <= label) {
    structures.resize(label + 1);
  }
  structures[label] = std::move(structure);
}

/// "red green blue hardness vital" of a bone that we wrote.
void take_properties(const std::string& words, Structure& structure) {
  std::istringstream in(words);
  Structure read = structure;
  if (in >> read.colour[0] >> read.colour[1] >> read.colour[2] >> read.hardness >> read.vital &&
      read.hardness > 0.0 && std::isfinite(read.hardness)) {
    structure = read;
  }
}

/// "red green blue" of 3D Slicer.
void take_colour(const std::string& words, Structure& structure) {
  std::istringstream in(words);
  std::array<double, 3> colour{};
  const auto within = [](double part) { return part >= 0.0 && part <= 1.0; };
  if (in >> colour[0] >> colour[1] >> colour[2] && std::ranges::all_of(colour, within)) {
    structure.colour = colour;
  }
}

Structure read_structure(Table& table, std::size_t label) {
  Structure structure = structure_named(table.text("name"), static_cast<std::uint8_t>(label));
  if (table.has("colour")) {
    const std::vector<double> colour = table.numbers("colour", kFraction, "");
    if (colour.size() == 3) {
      std::ranges::copy(colour, structure.colour.begin());
    } else {
      table.reject("colour",
                   fmt::format("has {} numbers; write three: red, green, blue", colour.size()));
    }
  }
  if (table.has("hardness")) {
    structure.hardness = table.number("hardness", {0.01, 100.0}, "");
  }
  if (table.has("vital")) {
    structure.vital = table.boolean("vital");
  }
  return structure;
}

}  // namespace

std::vector<Structure> structures_in(const std::map<std::string, std::string>& keys) {
  std::vector<Structure> structures(1);
  const auto value = [&](const std::string& key) {
    const auto found = keys.find(key);
    return found == keys.end() ? std::string() : found->second;
  };
  for (const auto& [key, name] : keys) {
    if (key.starts_with("Segment") && key.ends_with("_LabelValue")) {
      const std::string segment = key.substr(0, key.size() - std::string("_LabelValue").size());
      const auto label = label_in(name);
      if (label) {
        Structure structure =
            structure_named(value(segment + "_Name"), static_cast<std::uint8_t>(*label));
        take_colour(value(segment + "_Color"), structure);
        put(structures, *label, std::move(structure));
      }
    }
  }
  for (const auto& [key, name] : keys) {
    if (!key.starts_with("label_")) {
      continue;
    }
    if (const auto label = label_in(std::string_view(key).substr(6))) {
      Structure structure = structure_named(name, static_cast<std::uint8_t>(*label));
      take_properties(value(fmt::format("haptrial_{}", key)), structure);
      put(structures, *label, std::move(structure));
    }
  }
  return structures;
}

LabelTable read_label_table(const std::filesystem::path& file) {
  Table table = Table::load(file);
  LabelTable read{std::vector<Structure>(1), {}};
  if (table.has("names")) {
    Table names = table.table("names");
    for (const std::string& key : names.keys()) {
      read.names[key] = names.text(key);
    }
    if (!table.has("labels")) {
      table.finish();
      return read;
    }
  }
  Table labels = table.table("labels");
  std::vector<Structure>& structures = read.structures;
  for (const std::string& key : labels.keys()) {
    const auto label = label_in(key);
    Table entry = labels.table(key);
    if (!label) {
      labels.reject(key, "not a label", "1 to 255");
      entry.text("name");
      continue;
    }
    put(structures, *label, read_structure(entry, *label));
  }
  table.finish();
  return read;
}

std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r' || c == '\\'; }, ' ');
  return text;
}

std::map<std::string, std::string> keys_of(const std::vector<Structure>& structures) {
  std::map<std::string, std::string> keys;
  int segment = 0;
  for (std::size_t label = 1; label < structures.size(); ++label) {
    const Structure& structure = structures[label];
    if (structure.name.empty()) {
      continue;
    }
    const std::string key = fmt::format("label_{:02}", label);
    const std::string colour =
        fmt::format("{} {} {}", structure.colour[0], structure.colour[1], structure.colour[2]);
    const std::string name = one_line(structure.name);
    keys[key] = name;
    keys[fmt::format("haptrial_{}", key)] =
        fmt::format("{} {} {}", colour, structure.hardness, structure.vital ? 1 : 0);
    const std::string slicer = fmt::format("Segment{}_", segment++);
    keys[slicer + "ID"] = fmt::format("{}", label);
    keys[slicer + "LabelValue"] = fmt::format("{}", label);
    keys[slicer + "Layer"] = fmt::format("{}", 0);
    keys[slicer + "Name"] = name;
    keys[slicer + "Color"] = colour;
  }
  return keys;
}

}  // namespace haptrial::bone
