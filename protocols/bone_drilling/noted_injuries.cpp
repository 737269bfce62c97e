#include "protocols/bone_drilling/noted_injuries.h"

#include <fmt/format.h>

namespace haptrial::protocols {

void NotedInjuries::begin_bone(const bone::BoneModel& model, std::int32_t number) {
  model_ = &model;
  number_ = number;
}

void NotedInjuries::add(SessionFile& file, std::span<const record::RemovalRow> rows) {
  file.add(rows);
  for (const record::RemovalRow& row : rows) {
    const auto& structure = model_->structures[row.label];
    if (structure.vital && opened_.insert({number_, row.label}).second) {
      note(file, fmt::format("{} opened at {:.2f} N, on tick {}", structure.name, row.force,
                             row.sequence));
    }
  }
}

void NotedInjuries::add(SessionFile& file, std::span<const record::TearRow> rows) {
  file.add(rows);
  for (const record::TearRow& row : rows) {
    note(file, told(row));
    opened_.insert({number_, row.label});
    ++tears_;
  }
}

std::string NotedInjuries::told(const record::TearRow& row) const {
  constexpr double kMillimetres = 1000.0;
  const Eigen::Vector3d p = kMillimetres * (pose_of(d_.placement, model_->grid) * row.place).eval();
  const bool second = row.tool == record::kSecondHand;
  return fmt::format(
      "{} torn by {}{} at {:.2f} N, {:.1f} mm deep, at ({:.1f}, {:.1f}, {:.1f}) mm in the world, "
      "on tick {}",
      model_->structures[row.label].name,
      second ? "the tube in the other hand"
             : d_.simulator.tools[static_cast<std::size_t>(row.tool)].name,
      row.by_suction ? ", which sucks," : "", row.force, kMillimetres * row.depth, p.x(), p.y(),
      p.z(), row.sequence);
}

void NotedInjuries::note(SessionFile& file, const std::string& injury) {
  file.event("injury", injury);
  if (real_) {
    warnings_.push_back("injury: " + injury);
  }
}

}  // namespace haptrial::protocols
