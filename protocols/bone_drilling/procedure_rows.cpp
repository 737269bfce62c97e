#include "protocols/bone_drilling/procedure_rows.h"

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

}  // namespace haptrial::protocols
