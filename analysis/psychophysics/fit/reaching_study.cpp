#include "analysis/psychophysics/fit/reaching_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/psychophysics/fit/trials_plan.h"
#include "analysis/statistics/base/p_adjust.h"
#include "core/base/error.h"

namespace haptrial::analysis::trials {
namespace {

constexpr double kSamePerturbation = 0.25;  // blocks that differ by less are alike
constexpr double kLeastUnit = 1e-5;         // error below which a field disturbs nobody [m]

/// Index of a reach: number of the participant, of the block, and of the trial in the block.
struct ReachIndex {
  std::size_t participant{0}, block{0}, place{0};
};

using BlockKey = std::pair<int, std::string>;  // a session's number and a block's name in it

BlockKey key_of(const TrialsData& data, const StudyReach& reach) {
  return {data.session_of(data.trials[reach.trial]).session, reach.block};
}

/// Adds the blocks that somebody had, session after session. @returns their numbers
std::map<BlockKey, std::size_t> add_blocks(const TrialsData& data, ReachingResult& result) {
  std::map<BlockKey, std::size_t> numbers;
  for (const StudyReach& reach : result.reaches) {
    const BlockKey key = key_of(data, reach);
    if (numbers.emplace(key, 0).second) {
      const std::string session = factor_level(data, data.trials[reach.trial], kSession);
      ReachBlock& block = result.blocks.emplace_back();
      block.name = fmt::format("session {}, {}", session, reach.block);
      block.session = key.first;
      block.in_session = reach.block;
    }
  }
  std::ranges::stable_sort(result.blocks, {}, &ReachBlock::session);
  const bool several = result.blocks.front().session != result.blocks.back().session;
  for (std::size_t b = 0; b < result.blocks.size(); ++b) {
    ReachBlock& block = result.blocks[b];
    numbers[{block.session, block.in_session}] = b;
    block.name = several ? block.name : block.in_session;
  }
  return numbers;
}

std::vector<ReachIndex> standings(const TrialsData& data, ReachingResult& result) {
  const std::map<BlockKey, std::size_t> blocks = add_blocks(data, result);
  for (const StudySession& session : data.sessions) {
    result.participants.push_back(session.participant);
  }
  std::sort(result.participants.begin(), result.participants.end());
  result.participants.erase(std::unique(result.participants.begin(), result.participants.end()),
                            result.participants.end());
  std::vector<ReachIndex> all;
  for (const StudyReach& reach : result.reaches) {
    const std::string& name = data.session_of(data.trials[reach.trial]).participant;
    ReachIndex own;
    own.participant = static_cast<std::size_t>(
        std::lower_bound(result.participants.begin(), result.participants.end(), name) -
        result.participants.begin());
    own.block = blocks.at(key_of(data, reach));
    own.place = reach.place;
    ReachBlock& of = result.blocks[own.block];
    of.trials = std::max(of.trials, own.place + 1);
    all.push_back(own);
    result.persons.push_back(own.participant);
    result.block_of.push_back(own.block);
  }
  return all;
}

void lay_out(const std::vector<ReachIndex>& standings, ReachingResult& result) {
  std::vector<double> sums(result.blocks.size()), counts(result.blocks.size());
  for (std::size_t i = 0; i < standings.size(); ++i) {
    if (result.reaches[i].kind == ReachKind::kPlain) {
      sums[standings[i].block] += result.reaches[i].perturbation;
      counts[standings[i].block] += 1.0;
    }
  }
  std::size_t next = 0;
  double before = 0.0;
  for (std::size_t b = 0; b < result.blocks.size(); ++b) {
    ReachBlock& block = result.blocks[b];
    block.first_cycle = next;
    block.cycles = (block.trials + result.plan.cycle - 1) / result.plan.cycle;
    block.perturbation = counts[b] > 0.0 ? sums[b] / counts[b] : 0.0;
    const bool begins = b == 0 || result.blocks[b - 1].session != block.session;
    block.learns = std::abs(block.perturbation - before) > kSamePerturbation ||
                   (begins && std::abs(block.perturbation) > kSamePerturbation);
    before = block.perturbation;
    next += block.cycles;
  }
}

/// The curve of what `value` gives; participants and cycles are those of the study.
template <class Value>
ReachCurve curve_of(const std::vector<ReachIndex>& standings, const ReachingResult& result,
                    Value&& value) {
  ReachCurve curve;
  std::vector<TrialValue> values;
  for (std::size_t i = 0; i < standings.size(); ++i) {
    const ReachIndex& own = standings[i];
    const ReachBlock& block = result.blocks[own.block];
    const std::optional<double> one = value(result.reaches[i]);
    values.push_back({own.participant, block.first_cycle * result.plan.cycle + own.place, one});
    curve.reaches += one ? 1 : 0;
  }
  curve.table = cycle_means(values, result.plan.cycle);
  curve.points = learning_curve(curve.table);
  return curve;
}

/// The cycles of one block alone.
CycleTable cycles_of(const CycleTable& table, const ReachBlock& block) {
  CycleTable part;
  part.participants = table.participants;
  for (const auto& row : table.values) {
    const auto first = row.begin() + static_cast<std::ptrdiff_t>(block.first_cycle);
    part.values.emplace_back(first, first + static_cast<std::ptrdiff_t>(block.cycles));
  }
  return part;
}

CycleRange first_of(const ReachBlock& block) { return {block.first_cycle, block.first_cycle}; }
CycleRange last_of(const ReachBlock& block) {
  return {block.first_cycle + block.cycles - 1, block.first_cycle + block.cycles - 1};
}
CycleRange all_of(const ReachBlock& block) {
  return {block.first_cycle, block.first_cycle + block.cycles - 1};
}

bool has_values(const CycleTable& table, CycleRange range) {
  return std::any_of(table.values.begin(), table.values.end(), [&](const auto& row) {
    return std::any_of(row.begin() + static_cast<std::ptrdiff_t>(range.first),
                       row.begin() + static_cast<std::ptrdiff_t>(range.last) + 1,
                       [](const auto& value) { return value.has_value(); });
  });
}

void add(ReachingResult& result, std::string name, const char* unit, const CycleTable& table,
         CycleRange a, std::optional<CycleRange> b) {
  ReachContrast made{std::move(name), unit};
  made.contrast = cycle_contrast(table, a, b, Tail::kTwoSided);
  result.contrasts.push_back(std::move(made));
}

/// The block of the same name in the nearest session before; null: there is none.
const ReachBlock* earlier(const ReachingResult& result, const ReachBlock& block) {
  const ReachBlock* found = nullptr;
  for (const ReachBlock& other : result.blocks) {
    if (other.session < block.session && other.in_session == block.in_session) {
      found = &other;
    }
  }
  return found;
}

void add_plain_contrasts(ReachingResult& result) {
  const CycleTable& table = result.plain.table;
  const auto add_change = [&](const ReachBlock& block) {
    if (block.cycles > 1) {
      add(result, block.name + ": first cycle against its last", "m", table, first_of(block),
          last_of(block));
    }
  };
  std::vector<const ReachBlock*> bases;  // the first of each session
  for (const ReachBlock& block : result.blocks) {
    if (bases.empty() || bases.back()->session != block.session) {
      bases.push_back(&block);
    } else {
      add_change(block);
      add(result, block.name + ": first cycle against the last of " + bases.back()->name, "m",
          table, first_of(block), last_of(*bases.back()));
      add(result, block.name + ": first cycle against 0", "m", table, first_of(block),
          std::nullopt);
    }
    if (const ReachBlock* before = earlier(result, block)) {
      add(result, block.name + ": first cycle against that of " + before->name, "m", table,
          first_of(block), first_of(*before));
    }
  }
  for (const ReachBlock* base : bases) {
    add_change(*base);  // without a field before it, a check that nothing changes by itself
  }
}

void add_probe_contrasts(ReachingResult& result) {
  const ReachBlock* clamped = nullptr;
  for (const ReachBlock& block : result.blocks) {
    if (has_values(result.catches.table, all_of(block))) {
      add(result, block.name + ": catch trials against 0", "m", result.catches.table, all_of(block),
          std::nullopt);
    }
    if (!has_values(result.clamps.table, all_of(block))) {
      continue;
    }
    add(result, block.name + ": force compensation against 0", "", result.clamps.table,
        all_of(block), std::nullopt);
    if (clamped != nullptr) {
      add(result, block.name + ": force compensation against that of " + clamped->name, "",
          result.clamps.table, all_of(block), all_of(*clamped));
    } else {
      clamped = &block;
    }
  }
}

void adjust(ReachingResult& result) {
  std::vector<Defined<TTest>> tests;
  for (const ReachContrast& each : result.contrasts) {
    tests.push_back(each.contrast ? Defined<TTest>(each.contrast->test)
                                  : Undefined{each.contrast.because()});
  }
  const std::vector<Defined<double>> adjusted = holm_over(tests);
  for (std::size_t i = 0; i < adjusted.size(); ++i) {
    result.contrasts[i].holm = adjusted[i];
  }
}

ParticipantResampling resampling_of(const ReachingPlan& plan, const char* stream, int threads) {
  ParticipantResampling how;
  how.resampling = {plan.seed, stream, plan.resamples, threads};
  return how;
}

/// The error of the model of two rates, which knows no feedback: at 150 ms it has hardly acted,
/// while the largest error is what feedback has left of it.
std::optional<double> early_error(const StudyReach& reach) {
  return reach.kind == ReachKind::kPlain ? reach.turned(reach.error_at_150_ms) : std::nullopt;
}

/// The first block in a field; null: there is none.
const ReachBlock* first_in_field(const ReachingResult& result) {
  const auto found = std::ranges::find_if(result.blocks, [](const ReachBlock& block) {
    return std::abs(block.perturbation) > kSamePerturbation;
  });
  return found != result.blocks.end() ? &*found : nullptr;
}

/// Effect of the field before anything is learnt: mean early error of the first cycle in it [m].
double disturbance(const ReachingResult& result, const ReachCurve& early) {
  const ReachBlock* block = first_in_field(result);
  return block != nullptr && block->first_cycle < early.points.size()
             ? early.points[block->first_cycle].mean / block->perturbation
             : 0.0;
}

/// Errors in units of the disturbance, so that they weigh like the force compensation of clamps.
/// The model knows no nights, so that the first session in a field is fitted alone.
Defined<TwoRateLearning> two_rate_of(const std::vector<ReachIndex>& standings,
                                     const ReachingResult& result, int threads) {
  if (std::abs(result.two_rate_unit) < kLeastUnit) {
    return Undefined{"no block has a field that disturbs the reaches"};
  }
  const int session = first_in_field(result)->session;
  std::map<std::size_t, AdaptationSequence> sequences;
  for (std::size_t i = 0; i < standings.size(); ++i) {
    if (result.blocks[standings[i].block].session != session) {
      continue;
    }
    const StudyReach& reach = result.reaches[i];
    AdaptationTrial trial;
    trial.perturbation = reach.perturbation;
    trial.error_clamp = reach.kind == ReachKind::kClamp;
    if (trial.error_clamp) {
      trial.measured = reach.compensation ? reach.compensation->slope : kNotKnown;
    } else if (const auto error = reach.turned(reach.error_at_150_ms)) {
      trial.measured = *error / result.two_rate_unit;
    }
    sequences[standings[i].participant].push_back(trial);
  }
  std::vector<AdaptationSequence> all;
  for (auto& [participant, sequence] : sequences) {
    all.push_back(std::move(sequence));
  }
  TwoRateOptions options;
  options.fit_error_scale = true;
  return fit_two_rate_learning(all, options, resampling_of(result.plan, "two-rate", threads));
}

template <class Value>
Mean mean_of(const std::vector<ReachIndex>& standings, const ReachingResult& result,
             std::size_t block, ReachKind kind, Value&& value) {
  std::map<std::size_t, std::pair<double, double>> people;
  for (std::size_t i = 0; i < standings.size(); ++i) {
    if (standings[i].block != block || result.reaches[i].kind != kind) {
      continue;
    }
    if (const std::optional<double> one = value(result.reaches[i])) {
      people[standings[i].participant].first += *one;
      people[standings[i].participant].second += 1.0;
    }
  }
  std::vector<double> means;
  for (const auto& [participant, own] : people) {
    means.push_back(own.first / own.second);
  }
  return mean_and_interval(means);
}

BlockMeans means_of(const std::vector<ReachIndex>& standings, const ReachingResult& result,
                    std::size_t block) {
  using Reach = const StudyReach&;
  const auto plain = [&](auto value) {
    return mean_of(standings, result, block, ReachKind::kPlain, value);
  };
  BlockMeans means;
  means.movement_time = plain([](Reach r) { return r.metrics.movement_time; });
  means.peak_speed = plain([](Reach r) { return r.metrics.peak_speed; });
  means.error = plain([](Reach r) { return r.turned(r.metrics.maximum_perpendicular_error); });
  means.error_at_150_ms = plain([](Reach r) { return r.turned(r.error_at_150_ms); });
  means.direction = plain([](Reach r) { return r.turned(r.metrics.direction_error); });
  means.area = plain([](Reach r) { return r.turned(r.metrics.signed_area); });
  means.compensation = mean_of(standings, result, block, ReachKind::kClamp, [](Reach r) {
    return r.compensation ? std::optional(r.compensation->slope) : std::nullopt;
  });
  return means;
}

std::vector<ReachQuality> quality_of(const std::vector<ReachIndex>& standings,
                                     const ReachingResult& result) {
  std::vector<ReachQuality> all(result.participants.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].participant = result.participants[i];
  }
  for (std::size_t i = 0; i < standings.size(); ++i) {
    const StudyReach& reach = result.reaches[i];
    const ReachFlags& flags = reach.metrics.flags;
    ReachQuality& own = all[standings[i].participant];
    ++own.reaches;
    if (!reach.recorded) {
      ++own.not_recorded;
      continue;
    }
    own.no_onset += flags.no_onset || flags.moving_at_start || flags.not_finite ? 1 : 0;
    own.anticipated += flags.anticipated ? 1 : 0;
    own.never_slowed += flags.never_slowed ? 1 : 0;
    own.not_arrived += reach.arrived ? 0 : 1;
    own.missed_target += flags.missed_target ? 1 : 0;
    own.saturated += reach.saturated > 0.0 ? 1 : 0;
  }
  return all;
}

}  // namespace

std::optional<double> ReachingResult::error(const StudyReach& reach) const {
  return reach.turned(plan.at_150_ms ? reach.error_at_150_ms
                                     : reach.metrics.maximum_perpendicular_error);
}

ReachingResult reaching_study(const TrialsData& data, std::vector<StudyReach> reaches,
                              const ReachingPlan& plan, int threads) {
  ReachingResult result;
  result.plan = plan;
  result.reaches = std::move(reaches);
  if (std::none_of(result.reaches.begin(), result.reaches.end(),
                   [](const StudyReach& reach) { return reach.recorded; })) {
    throw InputError("no counted trial has the stage \"" + plan.stage +
                     "\", so no reach can be analysed");
  }
  const std::vector<ReachIndex> all = standings(data, result);
  lay_out(all, result);
  const auto error_of = [&](ReachKind kind) {
    return [&result, kind](const StudyReach& reach) {
      return reach.kind == kind ? result.error(reach) : std::nullopt;
    };
  };
  result.plain = curve_of(all, result, error_of(ReachKind::kPlain));
  result.catches = curve_of(all, result, error_of(ReachKind::kCatch));
  result.clamps = curve_of(all, result, [](const StudyReach& reach) {
    return reach.compensation ? std::optional(reach.compensation->slope) : std::nullopt;
  });
  for (std::size_t b = 0; b < result.blocks.size(); ++b) {
    ReachBlock& block = result.blocks[b];
    result.means.push_back(means_of(all, result, b));
    if (block.learns) {
      block.fit = fit_learning(cycles_of(result.plain.table, block),
                               resampling_of(plan, "participants", threads));
    }
  }
  add_plain_contrasts(result);
  add_probe_contrasts(result);
  adjust(result);
  result.two_rate_unit = disturbance(result, curve_of(all, result, early_error));
  result.two_rate = two_rate_of(all, result, threads);
  result.quality = quality_of(all, result);
  return result;
}

}  // namespace haptrial::analysis::trials
