#include "core/bone/hint/hint_rows.h"

namespace haptrial::record {
namespace {

constexpr std::int64_t kHintsSince = 5;

EnumText hint_kinds() {
  using hint::HintKind;
  return EnumText({{static_cast<std::uint8_t>(HintKind::kForce), "force"},
                   {static_cast<std::uint8_t>(HintKind::kSpeed), "speed"},
                   {static_cast<std::uint8_t>(HintKind::kHidden), "hidden"}});
}

}  // namespace

template <>
const Table<HintRow>& table_of<HintRow>() {
  using R = HintRow;
  using T = Table<R>;
  static const T table(
      {"hints",
       "hints to the participant, a row for each that ended",
       64,
       RowsOf::kTick,
       {"sequence"},
       hint::kHints,
       kHintsSince},
      {T::column("sequence", &R::sequence, "1", "tick on which it ended"),
       T::column("begin", &R::begin, "1", "tick of the removal that began it"),
       T::word("kind", &R::kind, kStatusBytes, hint_kinds(), "force, speed or hidden"),
       T::column("shown", &R::shown, "1", "1 where the participant saw it; else only recorded"),
       T::column("removals", &R::removals, "1", "that it was about, those before it began too"),
       T::text("structure", &R::structure, kNameBytes,
               "vital one nearest to the worst of these removals; empty: none within reach"),
       T::rounded("distance", &R::distance, "m", "from it; 0: none within reach"),
       T::rounded("force", &R::force, "N", "at the worst removal"),
       T::rounded("speed", &R::speed, "m/s", "of the tip, likewise"),
       T::rounded("limit_force", &R::limit_force, "N", "that is safe there; 0: not known"),
       T::rounded("limit_speed", &R::limit_speed, "m/s", "likewise")});
  return table;
}

template <>
const Table<HintLimitRow>& table_of<HintLimitRow>() {
  using R = HintLimitRow;
  using T = Table<R>;
  static const T table(
      {"hint_limits",
       "the safe forces and speeds that hints go by, a row for each interval of distance",
       64,
       RowsOf::kSession,
       {"limit"},
       "hint_limits",
       kHintsSince},
      {T::column("limit", &R::limit, "1", "from 0"),
       T::text("structure", &R::structure, kNameBytes, "of a bone, by name"),
       T::column("from", &R::from, "m", "distance of a removal from it"),
       T::column("to", &R::to, "m", "end of the interval, not in it"),
       T::column("force", &R::force, "N", "greatest that is safe"),
       T::column("speed", &R::speed, "m/s", "of the tip, likewise"),
       T::column("experts", &R::experts, "1", "from whom it was learned"),
       T::column("simulated", &R::simulated, "1", "1 where one of them was a program")});
  return table;
}

const TableList& hint_tables() {
  static const TableList tables{&table_of<HintLimitRow>(), &table_of<HintRow>()};
  return tables;
}

std::vector<HintLimitRow> limit_rows(const hint::SafeLimits& limits) {
  std::vector<HintLimitRow> rows;
  for (const hint::SafeStructure& structure : limits.structures) {
    for (const hint::SafeInterval& each : structure.intervals) {
      rows.push_back({static_cast<std::int32_t>(rows.size()), structure.name, each.from, each.to,
                      each.force, each.speed, static_cast<std::int32_t>(limits.participants),
                      limits.simulated});
    }
  }
  return rows;
}

}  // namespace haptrial::record
