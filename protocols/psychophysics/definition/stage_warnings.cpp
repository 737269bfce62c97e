#include "protocols/psychophysics/definition/stage_warnings.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <ranges>

#include "core/base/definition/table.h"
#include "protocols/psychophysics/definition/presented.h"
#include "protocols/psychophysics/definition/trials_definition.h"

namespace haptrial::protocols {
namespace {

/// A hand that rests wanders by less [m].
constexpr double kWander = 0.002;

bool has(std::uint64_t bits, std::size_t i) { return (bits >> i & 1U) != 0; }

std::vector<std::string> sentences_of(const std::map<std::string, std::string>& said) {
  const auto sentences = std::views::values(said);
  return {sentences.begin(), sentences.end()};
}

/// The field that leads a tool nearest to a region.
struct Lead {
  std::string field;
  double away{INFINITY};  // of its end from the region; 0 or less: inside [m]
};

Lead nearest_lead(const Presented& presented, std::uint64_t fields, std::size_t region) {
  const scene::PlacedShape shape(presented.regions[region].shape);
  const std::uint64_t acting = fields & presented.felt[presented.region_devices[region]];
  Lead lead;
  for (std::size_t f = 0; f < presented.fields.size(); ++f) {
    const auto end = has(acting, f) ? scene::traits_of(presented.fields[f]).leads_to : std::nullopt;
    const double away = end ? shape.distance(*end).distance : INFINITY;
    if (away < lead.away) {
      lead = {presented.fields[f].name, away};
    }
  }
  return lead;
}

/// Whether the middle, where hands begin, lies safely in a region.
bool holds_the_middle(const scene::Region& region) {
  return scene::PlacedShape(region.shape).distance(Eigen::Vector3d::Zero()).distance < -kWander;
}

std::string unled_words(const std::string& stage, const scene::Region& region) {
  const Eigen::Vector3d centre = scene::ball_of(region.shape).centre;
  return fmt::format(
      "stage {} waits until the tool is inside regions.{}, about ({:.3g}, {:.3g}, {:.3g}) m, and "
      "nothing leads it there; a person may go, a virtual participant does not",
      stage, region.name, centre.x(), centre.y(), centre.z());
}

}  // namespace

LeadReport::LeadReport(const TrialsDefinition& definition)
    : workspace_(definition.envelope.workspace_radius) {
  for (const TrialDevice& each : definition.hands) {
    tips_.push_back(each.is_tip());
  }
  Table root = definition.root();
  Table observer = root.table("observer");
  simulated_ = observer.has("actions");
  if (!simulated_) {
    return;
  }
  Table actions = observer.table("actions");
  for (const std::string& stage : actions.keys()) {
    const auto action = actions.table(stage).whole_text("do");
    if (!action || (*action != "rest" && *action != "hold")) {
      moving_.insert(stage);
    }
  }
}

void LeadReport::add(const Presented& presented) {
  std::uint64_t before = 0;  // fields of the stages before
  bool moved = false;        // the hand went somewhere by itself
  for (const NamedStage& named : presented.stages) {
    const Stage& stage = named.stage;
    moved = moved || moving_.contains(named.name);
    for (std::size_t r = 0; r < presented.regions.size(); ++r) {
      if (!has(stage.until.inside, r) || stage.late == Consequence::kGoOn) {
        continue;
      }
      const scene::Region& region = presented.regions[r];
      const Lead lead = nearest_lead(presented, stage.fields, r);
      if (std::isfinite(lead.away) && lead.away > 0.0) {
        beside_.try_emplace(
            named.name,
            fmt::format("stage {} waits until the tool is inside regions.{}, and fields.{} leads "
                        "it to a place {:.3g} m beside it; a hand that is led never arrives",
                        named.name, region.name, lead.field, lead.away));
      } else if (simulated_ && !moved &&
                 nearest_lead(presented, stage.fields | before, r).away > 0.0 &&
                 !holds_the_middle(region)) {
        beside_.try_emplace(named.name, unled_words(named.name, region));
      }
    }
    if (stage.until.inside == 0) {  // else a region ends the stage on the way
      add_way_out(presented, named.name, stage.fields);
    }
    before |= stage.fields;
  }
}

void LeadReport::add_way_out(const Presented& presented, const std::string& stage,
                             std::uint64_t fields) {
  for (std::size_t f = 0; f < presented.fields.size(); ++f) {
    const scene::FieldTraits traits = scene::traits_of(presented.fields[f]);
    bool at_tip = tips_.empty();
    for (std::size_t d = 0; d < tips_.size() && d < presented.felt.size(); ++d) {
      at_tip = at_tip || (tips_[d] && has(presented.felt[d], f));
    }
    if (!has(fields, f) || !at_tip || !traits.leads_to) {
      continue;
    }
    const Eigen::Vector3d& end = *traits.leads_to;
    if (end.norm() > workspace_) {
      beside_.try_emplace(
          stage,
          fmt::format("stage {}: fields.{} leads the hand to ({:.3g}, {:.3g}, {:.3g}) m, beyond "
                      "the workspace of {:g} m; a reading there ends the trial",
                      stage, presented.fields[f].name, end.x(), end.y(), end.z(), workspace_));
    }
  }
}

std::vector<std::string> LeadReport::warnings() const { return sentences_of(beside_); }

namespace {

/// Whether a stage takes no longer than it says.
bool ends_by_time(const Until& until) {
  const Until none;
  return until.inside == 0 && until.contact == 0 && until.buttons == 0 && until.keys == 0 &&
         until.speed_below == none.speed_below && until.speed_above == none.speed_above &&
         !until.channel;
}

}  // namespace

RampReport::RampReport(const TrialsDefinition& definition) {
  for (const DeviceArm& arm : definition.arms()) {
    ramps_.push_back(arm.limits.ramp_in);
  }
}

void RampReport::add(const Presented& presented) {
  if (presented.stages.empty()) {
    return;
  }
  const NamedStage& first = presented.stages.front();
  const double lasts = first.stage.until.soonest();
  for (std::size_t f = 0; f < presented.fields.size(); ++f) {
    const scene::FieldTraits traits = scene::traits_of(presented.fields[f]);
    const std::string& name = presented.fields[f].name;
    for (std::size_t device = 0; device < ramps_.size(); ++device) {
      const double ramp = ramps_[device];
      const bool felt = has(first.stage.fields & presented.felt[device], f);
      if (!felt || traits.leads_to || ramp == 0.0) {
        continue;
      }
      if (ends_by_time(first.stage.until) && lasts < 2.0 * ramp) {
        early_.try_emplace(name, ramped_in(fmt::format("fields.{} acts in the stage {}, which is "
                                                       "the first and ends after {:g} s",
                                                       name, first.name, lasts),
                                           ramp));
      } else if (traits.timed) {
        early_.try_emplace(name, ramped_in(fmt::format("fields.{} has a course in time, which "
                                                       "begins with the first stage, {}",
                                                       name, first.name),
                                           ramp));
      }
    }
  }
}

std::vector<std::string> RampReport::warnings() const { return sentences_of(early_); }

namespace {

/// The farthest place of a region that is drawn, from the middle of W along each axis [m].
Eigen::Vector3d reach_of(const scene::Shape& shape) {
  const scene::ShapeBall ball = scene::ball_of(shape);
  return ball.centre.cwiseAbs() + Eigen::Vector3d::Constant(ball.radius);
}

}  // namespace

void PictureReport::add(const Presented& presented) {
  const double eyes = d_.view.stereo ? 2.0 : 1.0;
  const double aspect = d_.display.width / (eyes * d_.display.height);
  for (const NamedStage& stage : presented.stages) {
    for (const std::string& name : stage.show) {
      const auto region = std::ranges::find(presented.regions, name, &scene::Region::name);
      if (region == presented.regions.end()) {
        continue;
      }
      const Eigen::Vector3d reach = reach_of(region->shape);
      const double down = d_.view.from_above ? reach.z() : reach.y();
      const double needed = 2.0 * std::max(reach.x(), aspect * down);
      if (needed > d_.view.width) {
        outside_[name] = std::max(outside_[name], needed);
      }
    }
  }
}

std::vector<std::string> PictureReport::warnings() const {
  std::vector<std::string> all;
  for (const auto& [name, needed] : outside_) {
    all.push_back(fmt::format(
        "region {} lies partly outside of the participant's picture, which is {:g} m wide; "
        "display.extent = {:g} shows all of it",
        name, d_.view.width, std::ceil(100.0 * needed) / 100.0));
  }
  return all;
}

}  // namespace haptrial::protocols
