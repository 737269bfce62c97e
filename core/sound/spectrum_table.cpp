#include "core/sound/spectrum_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/definition/table.h"

namespace haptrial::sound {
namespace {

constexpr double kHighest = 1e5;  // [Hz] nothing higher is heard or felt

bool good(const Spectrum& spectrum) {
  const auto bounded = [](double x) { return x >= 0.0 && std::isfinite(x); };
  const auto last = spectrum.peaks.begin() + std::clamp(spectrum.count, 0, Spectrum::kMaxPeaks);
  return spectrum.count >= 0 && spectrum.count <= Spectrum::kMaxPeaks && bounded(spectrum.noise) &&
         std::all_of(spectrum.peaks.begin(), last, [&](const Peak& peak) {
           return bounded(peak.frequency) && peak.frequency <= kHighest &&
                  bounded(peak.amplitude) && bounded(peak.bandwidth);
         });
}

void append(std::string& text, const char* key, const Spectrum& spectrum, double Peak::*field) {
  text += fmt::format("{} = [", key);
  for (int i = 0; i < spectrum.count; ++i) {
    text += fmt::format("{}{:.6g}", i == 0 ? "" : ", ",
                        spectrum.peaks[static_cast<std::size_t>(i)].*field);
  }
  text += "]\n";
}

void append(std::string& text, Burr burr, const Level& level, bool contact) {
  text += fmt::format("\n[{}.{}]\n", name_of(burr), level.name);
  if (contact) {
    text += fmt::format("force = {:.6g}  # [N]\n", level.force);
  }
  text += fmt::format("measured = {}\n", level.measured);
  append(text, "frequencies", level.spectrum, &Peak::frequency);
  append(text, "amplitudes", level.spectrum, &Peak::amplitude);
  append(text, "bandwidths", level.spectrum, &Peak::bandwidth);
  text += fmt::format("noise = {:.6g}\n", level.spectrum.noise);
}

Level read_level(Table& table, const std::string& name) {
  Level level;
  level.name = name;
  if (name != "free") {
    level.force = table.number("force", {0.0, 1000.0}, "N");
  }
  level.measured = table.boolean("measured");
  const auto frequencies = table.numbers("frequencies", {0.0, kHighest}, "Hz");
  const auto amplitudes = table.numbers("amplitudes", kNonNegative, "");
  const auto bandwidths = table.numbers("bandwidths", {0.0, kHighest}, "Hz");
  level.spectrum.noise = table.number("noise", kNonNegative, "");
  const std::size_t count = frequencies.size();
  if (count > Spectrum::kMaxPeaks) {
    table.reject("frequencies",
                 fmt::format("has {} numbers; allowed: at most {}", count, Spectrum::kMaxPeaks));
    return level;
  }
  for (const auto& [key, size] :
       {std::pair{"amplitudes", amplitudes.size()}, std::pair{"bandwidths", bandwidths.size()}}) {
    if (size != count) {
      table.reject(
          key, fmt::format("has {} numbers; write {}, as many as frequencies has", size, count));
      return level;
    }
  }
  level.spectrum.count = static_cast<int>(count);
  for (std::size_t i = 0; i < count; ++i) {
    level.spectrum.peaks[i] = {frequencies[i], amplitudes[i], bandwidths[i]};
  }
  return level;
}

void read_kind(Table& table, SpectrumTable::Kind& kind) {
  for (const std::string& name : table.keys()) {
    Table level = table.table(name);
    (name == "free" ? kind.free : kind.contact).push_back(read_level(level, name));
  }
  std::stable_sort(kind.contact.begin(), kind.contact.end(),
                   [](const Level& a, const Level& b) { return a.force < b.force; });
  for (std::size_t i = 1; i < kind.contact.size(); ++i) {
    if (kind.contact[i].force == kind.contact[i - 1].force) {
      table.reject(
          kind.contact[i].name,
          fmt::format("has the same force as another level, {:.6g} N; give each level its own",
                      kind.contact[i].force));
    }
  }
}

SpectrumTable read_document(Table& document) {
  SpectrumTable table;
  table.source = document.text("source");
  table.unit = document.choice("unit", {kFullScale, kNewton});
  bool any = false;
  for (const Burr burr : kBurrs) {
    if (const std::string key(name_of(burr)); document.has(key)) {
      Table kind = document.table(key);
      read_kind(kind, table.of(burr));
      any = any || !kind.keys().empty();
    }
  }
  if (!any) {
    document.reject("source",
                    "is given without a level; add a table [diamond.NAME] or [cutting.NAME]");
  }
  document.finish();
  return table;
}

}  // namespace

std::string_view name_of(Burr burr) { return burr == Burr::kDiamond ? "diamond" : "cutting"; }

Spectrum blend(const Spectrum& first, const Spectrum& second, double weight) noexcept {
  const auto mix = [weight](double a, double b) { return a + weight * (b - a); };
  Spectrum result;
  result.count = std::max(first.count, second.count);
  for (int i = 0; i < result.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    Peak a = first.peaks[at];
    Peak b = second.peaks[at];
    if (i >= first.count) {
      a = {b.frequency, 0.0, b.bandwidth};
    } else if (i >= second.count) {
      b = {a.frequency, 0.0, a.bandwidth};
    }
    result.peaks[at] = {mix(a.frequency, b.frequency), mix(a.amplitude, b.amplitude),
                        mix(a.bandwidth, b.bandwidth)};
  }
  result.noise = mix(first.noise, second.noise);
  return result;
}

Spectrum SpectrumTable::at(Burr burr, bool contact, double force) const noexcept {
  const Kind* kind = &of(burr);
  if (kind->free.empty() && kind->contact.empty()) {
    kind = &of(burr == Burr::kDiamond ? Burr::kCutting : Burr::kDiamond);
  }
  if (kind->contact.empty() && kind->free.empty()) {
    return {};
  }
  if (kind->contact.empty() || (!contact && !kind->free.empty())) {
    return kind->free.front().spectrum;
  }
  const auto above =
      std::find_if(kind->contact.begin(), kind->contact.end(),
                   [&](const Level& level) { return !contact || !(level.force < force); });
  if (above == kind->contact.begin()) {
    return above->spectrum;
  }
  if (above == kind->contact.end()) {
    return kind->contact.back().spectrum;
  }
  const Level& below = *std::prev(above);
  return blend(below.spectrum, above->spectrum,
               (force - below.force) / (above->force - below.force));
}

void check(const SpectrumTable& table) {
  bool any = false;
  for (const SpectrumTable::Kind& kind : table.kinds) {
    if (kind.free.size() > 1) {
      throw std::invalid_argument("SpectrumTable: a burr has one level in the air at most");
    }
    double last = -1.0;
    for (const auto* levels : {&kind.free, &kind.contact}) {
      for (const Level& level : *levels) {
        any = true;
        if (!good(level.spectrum)) {
          throw std::invalid_argument(fmt::format(
              "SpectrumTable: a number of the level '{}' is out of bounds", level.name));
        }
        const bool rises = levels == &kind.free || level.force > last;
        if (!(level.force >= 0.0) || !rises) {
          throw std::invalid_argument("SpectrumTable: forces must rise from 0 N up");
        }
        last = levels == &kind.free ? last : level.force;
      }
    }
  }
  if (!any) {
    throw std::invalid_argument("SpectrumTable: there is no level");
  }
}

std::string to_toml(const SpectrumTable& table) {
  const auto plain = [](std::string text) {
    std::replace_if(
        text.begin(), text.end(),
        [](char c) { return c == '"' || c == '\\' || static_cast<unsigned char>(c) < ' '; }, ' ');
    return text;
  };
  std::string text = fmt::format("source = \"{}\"\nunit = \"{}\"  # of amplitudes and noise\n",
                                 plain(table.source), plain(table.unit));
  for (const Burr burr : kBurrs) {
    for (const Level& level : table.of(burr).free) {
      append(text, burr, level, false);
    }
    for (const Level& level : table.of(burr).contact) {
      append(text, burr, level, true);
    }
  }
  return text;
}

SpectrumTable read_spectrum_table(const std::filesystem::path& file) {
  Table document = Table::load(file);
  return read_document(document);
}

SpectrumTable parse_spectrum_table(std::string_view text, std::string_view file_name) {
  Table document = Table::parse(text, file_name);
  return read_document(document);
}

}  // namespace haptrial::sound
