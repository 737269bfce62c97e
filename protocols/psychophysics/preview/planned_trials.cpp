#include "protocols/psychophysics/preview/planned_trials.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "protocols/psychophysics/sequence/trial_sequence.h"
#include "protocols/psychophysics/studied_definition.h"

namespace haptrial::protocols {
namespace {

void count_order(std::vector<PlannedOrder>& orders, const std::string& order) {
  const auto known = std::ranges::find(orders, order, &PlannedOrder::order);
  if (known == orders.end()) {
    orders.push_back({order, 1});
  } else {
    ++known->count;
  }
}

std::string order_of(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Trials of one session by kind, in the order in which each came first.
class SessionCounts {
 public:
  explicit SessionCounts(const PlannedCount& common) : common_(common) {}

  void add(const std::string& block, const std::string& condition, const std::string& probe,
           bool practice) {
    find(block, condition, probe, practice).all += 1;
  }
  /// A track of a procedure asks for at most so many.
  void set_open(const std::string& block, const std::string& track, bool practice, int most) {
    PlannedCount& count = find(block, track, "", practice);
    count.open = true;
    count.all = most;
  }
  const std::vector<PlannedCount>& counts() const { return counts_; }

 private:
  PlannedCount& find(const std::string& block, const std::string& condition,
                     const std::string& probe, bool practice) {
    const auto known = std::ranges::find_if(counts_, [&](const PlannedCount& count) {
      return count.block == block && count.condition == condition && count.probe == probe;
    });
    if (known != counts_.end()) {
      return *known;
    }
    PlannedCount count = common_;
    count.block = block;
    count.condition = condition;
    count.probe = probe;
    count.practice = practice;
    counts_.push_back(std::move(count));
    return counts_.back();
  }

  PlannedCount common_;
  std::vector<PlannedCount> counts_;
};

/// Goes through one session.
class SessionWalk {
 public:
  SessionWalk(const StudiedDefinition& d, const SessionPlace& place, PlannedTrials& planned)
      : d_(d), planned_(planned), sequence_(d, identity_of(d, place)), counts_(common(place)) {}

  std::vector<PlannedCount> walk() {
    note_blocks();
    for (auto next = sequence_.next(); next; next = sequence_.next()) {
      count(*next);
      sequence_.conclude(true, std::numeric_limits<double>::quiet_NaN(), false);
    }
    return counts_.counts();
  }

 private:
  PlannedCount common(const SessionPlace& place) const {
    PlannedCount count;
    count.session = place.session;
    count.group = d_.groups.size() > 1 ? group_of(d_.groups, place.subject) : "";
    return count;
  }

  void note_blocks() {
    std::vector<std::string> names;
    for (const std::size_t block : sequence_.blocks()) {
      names.push_back(d_.order.blocks[block].name);
    }
    count_order(planned_.block_orders, order_of(names));
  }

  void count(const NextTrial& next) {
    const Block& block = d_.order.blocks[next.values.block];
    const bool open = block.trials == 0;
    if (next.track >= 0 && open) {
      for (const RunningTrack& running : sequence_.running()) {
        counts_.set_open(block.name, running.name, block.practice, running.track->most_trials);
      }
      return;
    }
    if (open) {
      return;  // a probe among the trials of a procedure comes by chance
    }
    const std::string condition =
        next.track >= 0 ? sequence_.running()[static_cast<std::size_t>(next.track)].name
                        : next.plan.condition;
    counts_.add(block.name, condition, next.values.probe, block.practice);
    if (d_.intervals.size() > 1) {
      std::vector<std::string> names;
      for (const std::size_t interval : next.values.intervals) {
        names.push_back(d_.intervals[interval].name);
      }
      count_order(planned_.interval_orders, order_of(names));
    }
  }

  const StudiedDefinition& d_;
  PlannedTrials& planned_;
  TrialSequence sequence_;
  SessionCounts counts_;
};

bool same_kind(const PlannedCount& a, const PlannedCount& b) {
  return a.session == b.session && a.group == b.group && a.block == b.block &&
         a.condition == b.condition && a.probe == b.probe;
}

void merge(const std::vector<PlannedCount>& session, std::vector<PlannedCount>& all) {
  for (const PlannedCount& count : session) {
    const auto known =
        std::ranges::find_if(all, [&](const PlannedCount& each) { return same_kind(each, count); });
    if (known == all.end()) {
      all.push_back(count);
      all.back().participants = 1;
      all.back().fewest = all.back().most = count.all;
      continue;
    }
    known->participants += 1;
    known->fewest = std::min(known->fewest, count.all);
    known->most = std::max(known->most, count.all);
    known->all += count.all;
  }
}

/// Those who have no trial of a kind have the fewest.
void count_those_without(PlannedTrials& planned) {
  for (PlannedCount& count : planned.counts) {
    const auto group = std::ranges::find(planned.groups, count.group, &PlannedOrder::order);
    const int all = group == planned.groups.end() ? planned.participants : group->count;
    count.fewest = count.participants < all ? 0 : count.fewest;
  }
}

}  // namespace

PlannedTrials planned_trials(const StudiedDefinition& d, std::uint64_t seed, int most) {
  PlannedTrials planned;
  planned.participants = std::min(d.design.participants, most);
  for (int participant = 0; participant < planned.participants; ++participant) {
    SessionPlace place;
    place.subject = fmt::format("S{:02}", participant + 1);
    place.participant = participant;
    place.seed = seed;
    if (d.groups.size() > 1) {
      count_order(planned.groups, group_of(d.groups, place.subject));
    }
    for (place.session = 1; place.session <= d.order.sessions; ++place.session) {
      if (!d.comes(place.session, group_of(d.groups, participant))) {
        continue;
      }
      give_seeds(place);
      merge(SessionWalk(d, place, planned).walk(), planned.counts);
    }
  }
  count_those_without(planned);
  return planned;
}

}  // namespace haptrial::protocols
