#include "protocols/trials/definition/every_value.h"

#include <fmt/format.h>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/scene/scene.h"
#include "protocols/trials/definition/defaults.h"
#include "protocols/trials/definition/trial_values.h"
#include "protocols/trials/definition/trials_definition.h"

namespace haptrial::protocols {
namespace {

constexpr std::size_t kMostCombinations = 256;

std::string words_of(const TrialsDefinition& d, const TrialValues& values) {
  std::string words = fmt::format("block {}", d.order.blocks[values.block].name);
  for (const auto& [name, level] : values.levels) {
    words += fmt::format(", {} = {:g}", name, level);
  }
  for (const GivenValue& value : values.values) {
    words += fmt::format(", {} = {}", value.name, value.formula);
  }
  return words;
}

void present_once(const TrialsDefinition& d, const TrialValues& values) {
  Table root = Table::parse(d.text, d.file_name);
  root.fill_in(trials_defaults());
  const std::unique_ptr<Names> names = read_names(root, d);
  try {
    for (std::size_t place = 0; place < d.intervals.size(); ++place) {
      give(*names, d, values);
      give_interval(*names, d.intervals[values.intervals[place]], place);
      const Presented presented = read_presented(root, *names, d.rate, nullptr);
      root.check();
      scene::Scene(presented.fields, d.rate);
    }
    give(*names, d, values);
    for (const Question& question : d.questions) {
      if (!question.correct.empty()) {
        right_choice(*names, question);
      }
    }
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}\n(with {})", error.what(), words_of(d, values)));
  }
}

}  // namespace

void check_every_value(const TrialsDefinition& d) {
  for (std::size_t block = 0; block < d.order.blocks.size(); ++block) {
    std::size_t combinations = 1;
    for (const Factor& factor : d.order.factors) {
      combinations = std::min(kMostCombinations, combinations * factor.levels.size());
    }
    for (std::size_t c = 0; c < combinations; ++c) {
      for (const bool high : {false, true}) {
        TrialValues values;
        values.block = block;
        values.group = d.groups.empty() ? "" : d.groups.front().name;
        for (std::size_t i = 0; i < d.intervals.size(); ++i) {
          values.intervals.push_back(i);
        }
        for (const Track& track : d.tracks) {
          values.levels.emplace_back(track.variable, track.applied(high ? track.high : track.low));
        }
        std::size_t rest = c;
        for (const Factor& factor : d.order.factors) {
          values.values.push_back({factor.name, factor.levels[rest % factor.levels.size()]});
          rest /= factor.levels.size();
        }
        const Block& given = d.order.blocks[block];
        values.values.insert(values.values.end(), given.values.begin(), given.values.end());
        present_once(d, values);
      }
    }
  }
}

}  // namespace haptrial::protocols
