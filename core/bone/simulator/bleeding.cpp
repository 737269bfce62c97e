#include "core/bone/simulator/bleeding.h"

#include <algorithm>

#include "core/base/definition/schema.h"
#include "core/bone/data/anatomy.h"

namespace haptrial::bone {

const Schema<BleedingParameters>& bleeding_schema() {
  using P = BleedingParameters;
  static const auto schema =
      Schema<P>()
          .texts("structures", &P::structures,
                 "Structures of the bone, by any of their names, that bleed if they are opened")
          .required()
          .check([](Table& table, P& p) {
            if (p.structures.empty()) {
              table.reject("structures",
                           "is empty; name structures that bleed, as \"sigmoid sinus\"");
            }
          })
          .number("rate", &P::rate, {1e-9, 1e-5}, "m3/s",
                  "Volume of blood that flows in a second from each opening of a structure");
  return schema;
}

namespace {

/// A definition may be for several bones: a known structure that one of them lacks does not bleed.
std::vector<std::uint8_t> bleeding_labels(const BoneModel& model,
                                          const BleedingParameters& parameters) {
  std::vector<std::uint8_t> labels;
  for (const std::string& name : parameters.structures) {
    if (find_label(model, name) || !is_known_structure(name)) {
      labels.push_back(label_named(model, name, "bleeding"));
    }
  }
  return labels;
}

}  // namespace

void check_bleeding(const BoneModel& model, const BleedingParameters& parameters) {
  bleeding_labels(model, parameters);
}

Bleeding::Bleeding(const BoneModel& model, const BleedingParameters& parameters)
    : spacing_(model.grid.spacing), any_(!parameters.structures.empty()) {
  for (const std::uint8_t label : bleeding_labels(model, parameters)) {
    bleeds_[label] = true;
  }
  rate_ = parameters.rate / (spacing_ * spacing_ * spacing_);
  openings_.reserve(kMost);
  owed_.reserve(kMost);
  deposits_.reserve(kMost);
}

void Bleeding::begin_tick() noexcept {
  before_ = openings_.size();
  deposits_.clear();
}

void Bleeding::open(std::uint8_t label, const Eigen::Vector3d& place_B) noexcept {
  const bool part_of_another =
      std::any_of(openings_.begin(), openings_.end(), [&](const Opening& other) {
        return other.label == label && (other.place_B - place_B).norm() < kApart;
      });
  if (bleeds(label) && !part_of_another && openings_.size() < kMost) {
    openings_.push_back({label, place_B});
    owed_.push_back(0.0);
  }
}

void Bleeding::tick(const Eigen::Isometry3d& pose_WB, double dt) noexcept {
  ++ticks_;
  for (std::size_t i = 0; i < openings_.size(); ++i) {
    owed_[i] += rate_ * dt;
    if (ticks_ % kBetween == i % kBetween) {
      deposits_.push_back({pose_WB * openings_[i].place_B, 0.5 * spacing_, owed_[i]});
      owed_[i] = 0.0;
    }
  }
}

}  // namespace haptrial::bone
