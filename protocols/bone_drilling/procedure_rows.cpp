#include "protocols/bone_drilling/procedure_rows.h"

#include <fmt/format.h>

namespace haptrial::protocols {

std::vector<record::BurrRow> burr_rows(std::span<const bone::ToolSpec> tools) {
  std::vector<record::BurrRow> rows;
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    if (const auto* burr = tools[tool].as<bone::BurrTool>()) {
      const bone::BurrParameters& p = burr->burr;
      const bone::ShaftParameters none{0.0, 0.0, {}};
      const bone::ShaftParameters& shaft = burr->shaft ? *burr->shaft : none;
      rows.push_back({static_cast<std::int32_t>(tool), tools[tool].name,
                      static_cast<std::uint8_t>(p.kind), static_cast<std::uint8_t>(p.form),
                      p.diameter, 2.0 * bone::BurrShape(p.dimensions()).half_length(),
                      p.narrow_diameter, p.clockwise, shaft.radius, shaft.length, p.wear_volume});
    }
  }
  return rows;
}

record::ProcedureRow procedure_of(const BoneStage& stage, std::int32_t pass, std::int32_t bone) {
  const bone::Simulator& simulator = *stage.simulator;
  const bone::DustBalance dust = stage.companions->dust();
  record::ProcedureRow procedure;
  procedure.pass = pass;
  procedure.bone = bone;
  procedure.pieces = simulator.pieces();
  procedure.emptied = simulator.emptied_so_far();
  procedure.before = simulator.amount_at_start();
  procedure.left = simulator.amount_left();
  procedure.cut = simulator.cut_so_far();
  procedure.dust = dust.lying + dust.held;
  procedure.suctioned = dust.suctioned;
  procedure.fallen = dust.fallen;
  procedure.checksum = simulator.checksum();
  return procedure;
}

record::FieldRow field_of(const BoneStage& stage, std::int32_t pass) {
  const bone::Simulator& simulator = *stage.simulator;
  const double spacing = stage.model->grid.spacing;
  const double voxel = spacing * spacing * spacing;
  const bone::DustBalance blood = stage.companions->blood();
  record::FieldRow field;
  field.pass = pass;
  field.bled = voxel * blood.deposited;
  field.blood_sucked = voxel * blood.suctioned;
  field.blood_lying = voxel * (blood.lying + blood.held);
  if (simulator.heat() != nullptr) {
    field.hottest = simulator.heat()->hottest();
    field.harmful_time = simulator.heat()->harmful_time();
  }
  return field;
}

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
