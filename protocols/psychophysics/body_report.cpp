#include "protocols/psychophysics/body_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/deformable/touch/moving_touch.h"
#include "core/deformable/touch/two_rate_touch.h"
#include "core/record/rows/object_rows.h"
#include "protocols/psychophysics/sequence/trial_sequence.h"

namespace haptrial::protocols {
namespace {

using deformable::TouchCounts;

/// Ticks on which a body was not felt as it should be.
struct Loss {
  std::uint64_t TouchCounts::*ticks;
  const char* table;
  const char* event;
  const char* what;
};

constexpr std::array<Loss, BodyReport::kLosses> kAllLosses{
    Loss{&TouchCounts::inverted, "/touched_bodies", "inside_out",
         "the hand pressed a body deeper than its elements can follow, and the force did not grow"},
    Loss{&TouchCounts::crowded, "/touched_bodies", "crowded_contact",
         "the ball lay on more places of the body than are computed; it may have been felt softer "
         "than its elements (use fewer cells or a smaller ball)"},
    Loss{&TouchCounts::limited, "/moving_bodies", "energy_limit",
         "the force was cut, as it might have given out more energy than the hand had given"},
    Loss{&TouchCounts::flown_apart, "/moving_bodies", "flown_apart",
         "the body flew apart, deformed beyond what its steps are stable for, and was put to rest "
         "(use a shorter step, or of springs smaller constants, more density or fewer cells)"},
    Loss{&TouchCounts::late, "/late_windows", "late_body",
         "a body of its own rate was late and felt as it had been before (use fewer cells, of "
         "springs "
         "smaller constants or more density, or a machine with less other work)"},
};

void add(const TouchCounts& more, TouchCounts& to) {
  to.contact += more.contact;
  to.inverted += more.inverted;
  to.unsettled += more.unsettled;
  to.crowded += more.crowded;
  to.limited += more.limited;
  to.flown_apart += more.flown_apart;
  to.late += more.late;
}

}  // namespace

void BodyReport::add_tables(record::TableList& tables) const {
  if (std::ranges::any_of(objects_, &TrialObject::yields)) {
    tables.push_back(&record::table_of<record::TouchedBodyRow>());
  }
  if (std::ranges::any_of(objects_, &TrialObject::moves)) {
    tables.push_back(&record::table_of<record::MovingBodyRow>());
  }
  if (std::ranges::any_of(objects_, &TrialObject::own_rate)) {
    tables.push_back(&record::table_of<record::LateWindowRow>());
  }
}

const deformable::BodyTouch* BodyReport::touch_of(const TrialPass& pass, std::size_t interval,
                                                  std::size_t device, std::size_t object) const {
  const scene::Scene& scene = pass.scenes(interval)[device];
  return scene.touch(scene.size() - objects_.size() + object);
}

BodyReport::TouchedObject BodyReport::touched(const TrialPass& pass, std::size_t device,
                                              std::size_t object) const {
  TouchedObject sum{device, object, {}, 0};
  for (std::size_t i = 0; i < pass.intervals_begun(); ++i) {
    const deformable::BodyTouch* touch = touch_of(pass, i, device, object);
    if (touch != nullptr) {
      add(touch->counts(), sum.counts);
    }
    if (const auto* moving = dynamic_cast<const deformable::MovingTouch*>(touch)) {
      sum.steps = moving->steps();
    }
    if (const auto* moving = dynamic_cast<const deformable::TwoRateTouch*>(touch)) {
      sum.steps = moving->steps();
    }
  }
  return sum;
}

void BodyReport::add_rows(const std::vector<TouchedObject>& all, std::int32_t row,
                          SessionFile& file) const {
  std::vector<record::TouchedBodyRow> touched;
  std::vector<record::MovingBodyRow> moving;
  for (const TouchedObject& each : all) {
    const TrialObject& object = objects_[each.object];
    const TouchCounts& c = each.counts;
    const auto device = static_cast<std::int32_t>(each.device);
    touched.push_back({row, device, object.name, c.contact, c.inverted, c.unsettled, c.crowded});
    if (object.moves) {
      moving.push_back({row, device, object.name, each.steps, c.limited, c.flown_apart});
    }
  }
  file.add(std::span<const record::TouchedBodyRow>(touched));
  if (!moving.empty()) {
    file.add(std::span<const record::MovingBodyRow>(moving));
  }
}

void BodyReport::add_late(const TrialPass& pass, const TouchedObject& body, std::int32_t row,
                          SessionFile& file) const {
  std::vector<record::LateWindowRow> rows;
  for (std::size_t i = 0; i < pass.intervals_begun(); ++i) {
    if (const auto* touch = dynamic_cast<const deformable::TwoRateTouch*>(
            touch_of(pass, i, body.device, body.object))) {
      for (const deformable::LateWindow& late : touch->late()) {
        rows.push_back({row, static_cast<std::int32_t>(body.device),
                        static_cast<std::int32_t>(i + 1), objects_[body.object].name, late.tick,
                        late.ticks});
      }
    }
  }
  if (!rows.empty()) {
    file.add(std::span<const record::LateWindowRow>(rows));
  }
}

void BodyReport::keep(const TrialPass& pass, std::int32_t row, SessionFile& file) {
  std::vector<TouchedObject> all;
  for (std::size_t device = 0; device < pass.scenes(0).size(); ++device) {
    for (std::size_t object = 0; object < objects_.size(); ++object) {
      if (objects_[object].yields) {
        all.push_back(touched(pass, device, object));
      }
    }
  }
  if (all.empty()) {
    return;
  }
  add_rows(all, row, file);
  const int trial = pass.trial() % kPracticeNumbers;
  for (const TouchedObject& each : all) {
    add_late(pass, each, row, file);
    for (std::size_t i = 0; i < kLosses; ++i) {
      const Loss& loss = kAllLosses[i];
      if (const std::uint64_t ticks = each.counts.*loss.ticks; ticks > 0) {
        sums_[i].ticks += ticks;
        ++sums_[i].bodies;
        file.event(loss.event, fmt::format("trial {}: {}: on {} ticks {}", trial,
                                           objects_[each.object].name, ticks, loss.what));
      }
    }
  }
}

std::vector<std::string> BodyReport::notices() const {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < kLosses; ++i) {
    const Sum& sum = sums_[i];
    if (sum.ticks > 0) {
      lines.push_back(fmt::format("bodies that give way, in {} of {}: on {} ticks {}",
                                  sum.bodies == 1 ? "1 pass" : fmt::format("{} passes", sum.bodies),
                                  kAllLosses[i].table, sum.ticks, kAllLosses[i].what));
    }
  }
  return lines;
}

}  // namespace haptrial::protocols
