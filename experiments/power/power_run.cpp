#include "experiments/power/power_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <thread>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "experiments/control/progress.h"
#include "experiments/control/signals.h"
#include "experiments/study/shared_work.h"

namespace haptrial::experiments {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The missing units of a share, as places in PowerFolder::units.
std::vector<std::size_t> own_units(const PowerFolder& folder, const PowerShare& share) {
  std::set<std::string> missing;
  for (const PowerUnit& unit : folder.missing()) {
    missing.insert(unit.file());
  }
  std::vector<std::size_t> own;
  const std::vector<PowerUnit>& units = folder.units();
  for (auto i = static_cast<std::size_t>(share.part - 1); i < units.size();
       i += static_cast<std::size_t>(share.of)) {
    if (missing.contains(units[i].file())) {
      own.push_back(i);
    }
  }
  const auto first = static_cast<std::ptrdiff_t>(share.start * static_cast<double>(own.size()));
  std::ranges::rotate(own, own.begin() + first);
  return own;
}

/// Work of a process's threads on units, and its results.
class Filling {
 public:
  Filling(const PowerFolder& folder, const PowerQuestion& question, const PowerShare& share)
      : folder_(folder), question_(question), share_(share), locks_(folder.path() / kLocks) {}

  /// Makes a unit unless another process does, or has. @returns whether the part is there
  bool make(std::size_t unit) {
    if (is_over()) {
      return true;
    }
    const PowerUnit& one = folder_.units()[unit];
    const TakenUnit taken(locks_, unit);
    if (!taken) {
      return false;
    }
    if (folder_.has(one)) {
      return true;
    }
    try {
      keep(one);
    } catch (const RunError&) {
      if (!interrupted()) {
        throw;
      }
      stopped_ = true;
    }
    return true;
  }

  /// Whether nothing else may be begun.
  bool is_over() {
    if (interrupted() || (share_.minutes && seconds() > 60.0 * *share_.minutes)) {
      stopped_ = true;
    }
    return stopped_;
  }

  std::size_t made() const { return made_; }
  double seconds() const { return seconds_since(start_); }
  PowerProgress progress() const {
    return {made_, folder_.missing().size(), trials_, seconds(), stopped_};
  }

 private:
  static constexpr const char* kLocks = "parts.lock";

  void keep(const PowerUnit& unit) {
    const std::vector<SimulatedStudy> studies = simulated(question_, unit);
    folder_.keep(unit, studies);
    for (const SimulatedStudy& study : studies) {
      trials_ += study.trials;
    }
    ++made_;
  }

  const PowerFolder& folder_;
  const PowerQuestion& question_;
  const PowerShare& share_;
  UnitLocks locks_;
  Clock::time_point start_{Clock::now()};
  std::atomic<std::size_t> made_{0};
  std::atomic<std::uint64_t> trials_{0};
  std::atomic<bool> stopped_{false};
};

/// Units that other processes make: each is there in the end, or its process died.
void wait_for(const std::vector<std::size_t>& units, Filling& filling) {
  constexpr auto kPause = std::chrono::milliseconds(100);
  for (const std::size_t unit : units) {
    while (!filling.make(unit)) {
      if (filling.is_over()) {
        return;
      }
      std::this_thread::sleep_for(kPause);
    }
  }
}

struct FirstTests {
  std::vector<std::string> names;
  std::string because;  // why a study made none
};

/// The tests of the first simulated study that could make any.
FirstTests first_tests(const PowerQuestion& question) {
  constexpr int kStudies = 3;
  FirstTests first;
  for (int i = 0; i < kStudies && first.names.empty(); ++i) {
    const PowerUnit unit{0, question.plan.depth == PowerDepth::kSessions, i, 1};
    const SimulatedStudy study = simulated(question, unit).front();
    for (const NamedNumber& test : study.tests) {
      first.names.push_back(test.name);
    }
    first.because = study.failures.empty() ? first.because : study.failures.front();
  }
  return first;
}

}  // namespace

void check_watched(const PowerQuestion& question) {
  const std::string& watch = question.plan.watch;
  if (const auto made = first_tests(question); std::ranges::count(made.names, watch) > 0) {
    return;
  }
  PowerQuestion any = question;  // some tests are made only if one of them is watched
  any.plan.watch.clear();
  const FirstTests all = first_tests(any);
  if (all.names.empty()) {
    throw InputError(fmt::format("{}: the report has no test at all{}{}", question.file_name,
                                 all.because.empty() ? "" : ": ", all.because));
  }
  throw InputError(fmt::format(
      "{}: power.watch is \"{}\", which a first study could not make{}{}; made, and allowed: "
      "\"{}\"",
      question.file_name, watch, all.because.empty() ? "" : ", because ", all.because,
      fmt::join(all.names, "\", \"")));
}

PowerProgress fill(const PowerFolder& folder, const PowerQuestion& question,
                   const PowerShare& share) {
  const std::vector<std::size_t> own = own_units(folder, share);
  Filling filling(folder, question, share);
  std::mutex mutex;
  std::vector<std::size_t> elsewhere;  // made by other processes
  const auto work = [&](std::size_t i) {
    if (!filling.make(own[i])) {
      const std::lock_guard lock(mutex);
      elsewhere.push_back(own[i]);
    }
  };
  {
    SharedWork shared(own.size(), share.jobs, [&] { return SharedWork::Work(work); });
    Progress progress("power", static_cast<double>(own.size()));
    while (!shared.ended_within(std::chrono::milliseconds(50))) {
      progress.update(static_cast<double>(filling.made()),
                      fmt::format("{} of {} parts", filling.made(), own.size()), 0.0);
    }
    shared.finish();
  }
  std::ranges::sort(elsewhere);
  wait_for(elsewhere, filling);
  return filling.progress();
}

}  // namespace haptrial::experiments
