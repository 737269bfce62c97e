#include "protocols/bone_drilling/definition/bone_definition.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "protocols/bone_drilling/definition/bone_tables_internal.h"
#include "protocols/definition/groups.h"

namespace haptrial::protocols {
namespace {

namespace fs = std::filesystem;

protocols::Design read_procedures(Table& table) {
  protocols::Design design;
  design.repetitions = 1;
  design.break_after = 0;
  design.break_duration = 0.0;
  procedures_schema().read(table, design);
  design.break_until_ready = protocols::read_break_until_ready(table, design.break_after);
  design.conditions = {"drilling"};
  if (design.break_after >= design.trials && design.break_after > 0) {
    table.reject(
        "break_after", fmt::format("{}", design.break_after),
        fmt::format("a whole number below the {} procedures, or 0 for no break", design.trials));
  }
  return design;
}

DrillingParameters read_drilling(Table& root) {
  Table table = root.table("drilling");
  DrillingParameters p = drilling_schema().read(table);
  if (root.has("second_hand")) {
    Table second = root.table("second_hand");
    p.second = second_hand_schema().read(second);
  }
  p.controls = read_controls(root);
  return p;
}

/// The sessions, of which each may have a number of procedures of its own; the design has the most.
void read_sessions(Table& root, BoneDefinition& d) {
  const int usual = d.design.trials;
  d.session_plans = read_session_plans(
      root, d.design.sessions, "a name at least", [&](Table& session, int number) {
        session.describe(
            {"procedures", "Number of procedures of the session", "design.procedures"});
        d.procedures.resize(static_cast<std::size_t>(number), usual);
        d.procedures.back() = session.integer_or("procedures", usual, 1, 1000);
      });
  if (!d.procedures.empty()) {
    d.design.trials = *std::ranges::max_element(d.procedures);
  }
}

subject::SurgeonBurr burr_named(Table& table, const char* key, const BoneDefinition& d) {
  const std::string name = table.text(key);
  for (std::size_t tool = 0; tool < d.simulator.tools.size(); ++tool) {
    const bone::ToolSpec& spec = d.simulator.tools[tool];
    const auto* burr = spec.as<bone::BurrTool>();
    if (spec.name == name && burr != nullptr) {
      if (burr->burr.form != bone::BurrForm::kBall) {
        table.reject(key, fmt::format("\"{}\"", name), "a burr whose shape is a ball");
      }
      return {static_cast<int>(tool), burr->radius()};
    }
  }
  table.reject(key, fmt::format("\"{}\"", name), "a burr of tools.in_hand");
  return {0, 0.5e-3};
}

void read_surgeons(Table& root, BoneDefinition& d) {
  if (!root.has("virtual_surgeons")) {
    return;
  }
  Table table = root.table("virtual_surgeons");
  subject::SurgeonParameters p;
  table.describe({"rough", "Burr with which a virtual surgeon removes most of the bone", ""});
  p.rough = burr_named(table, "rough", d);
  table.describe({"fine", "Burr with which a virtual surgeon works near structures", ""});
  p.fine = burr_named(table, "fine", d);
  surgeon_schema().read(table, p);
  table.describe({"skill", "Skill of virtual surgeons, from 0 to 1", ""});
  if (!root.has("groups")) {
    p.skill = table.number("skill", kFraction, "");
  } else {
    Table skill = table.table("skill");
    for (const StudyGroup& group : d.groups) {
      skill.describe({group.name, "Skill of the virtual surgeons of a group, from 0 to 1", ""});
      d.group_skills[group.name] = skill.number(group.name, kFraction, "");
    }
  }
  if (!root.has("cavity")) {
    root.reject("virtual_surgeons", "needs a cavity; add a table [cavity]");
  }
  d.surgeon = p;
}

void read_osteotomy(Table& root, BoneDefinition& d) {
  if (root.has("osteotomy")) {
    Table table = root.table("osteotomy");
    d.osteotomy = subject::fragment_plan_schema().read(table);
  }
  if (root.has("osteotomy_hand")) {
    Table table = root.table("osteotomy_hand");
    d.osteotomy_hand = subject::osteotomy_hand_schema().read(table);
    if (!d.osteotomy) {
      root.reject("osteotomy_hand", "needs a plan; add a table [osteotomy]");
    }
    for (const char* missing : subject::missing_tools(d.simulator.tools)) {
      root.reject("osteotomy_hand",
                  fmt::format("needs a tool of type \"{}\" in tools.in_hand", missing));
    }
  }
}

/// A criterion about the score needs the score.
void check_scored(Table& root, const BoneDefinition& d) {
  if (!d.curriculum || !d.score_file.empty()) {
    return;
  }
  for (const bone::CurriculumCase& each : d.curriculum->cases) {
    if (std::ranges::find(each.pass, bone::kScoreQuantity, &bone::Criterion::quantity) !=
        each.pass.end()) {
      root.reject("curriculum", "asks for a score; name its file in feedback.score");
    }
  }
}

/// @param folder  of the file; null: tables of spectra are not read
void read_sound(Table& root, BoneDefinition& d, const fs::path* folder) {
  d.sound_table = sound::default_sound();
  d.vibration_table = sound::default_vibration();
  if (!root.has("sound")) {
    return;
  }
  Table table = root.table("sound");
  bone_sound_schema().read(table, d);
  const auto spectra = [&](const char* key, const char* words, sound::SpectrumTable& into) {
    table.describe({key, words, "built in"});
    if (table.has(key)) {
      const std::string name = table.text(key);
      if (folder != nullptr) {
        const std::string unit = into.unit;
        into = sound::read_spectrum_table(*folder / name);
        if (into.unit != unit) {
          table.reject(key, fmt::format("{}, which has the unit {}", name, into.unit),
                       fmt::format("spectra of the unit {}", unit));
        }
      }
    }
  };
  spectra("spectra", "File with spectra of the drill's sound, relative to the definition",
          d.sound_table);
  spectra("vibration", "File with spectra of the drill's vibration, relative to the definition",
          d.vibration_table);
}

void check_together(Table& root, const BoneDefinition& d) {
  Table drilling = root.table("drilling");
  if (d.drilling.force_limit > d.envelope.max_force) {
    drilling.reject("force_limit", fmt::format("{}", d.drilling.force_limit),
                    fmt::format("at most envelope.max_force, {} [N]", d.envelope.max_force));
  }
  if (d.drilling.second && d.drilling.second->force_limit > d.envelope.max_force) {
    root.table("second_hand")
        .reject("force_limit", fmt::format("{}", d.drilling.second->force_limit),
                fmt::format("at most envelope.max_force, {} [N]", d.envelope.max_force));
  }
  if (d.forbidden && d.forbidden->most_force() > d.drilling.force_limit) {
    root.table("forbidden")
        .reject("force_limit", fmt::format("{}", d.forbidden->most_force()),
                fmt::format("at most drilling.force_limit, {} [N]", d.drilling.force_limit));
  }
  for (const bone::SoftTissueParameters& soft : d.simulator.soft_tissue) {
    if (soft.tears_at > d.drilling.force_limit) {
      root.reject("soft_tissue",
                  fmt::format("has '{}' tear at {} N, which the hand would not feel; allowed: at "
                              "most drilling.force_limit, {} [N]",
                              soft.structure, soft.tears_at, d.drilling.force_limit));
    }
  }
  if (root.has("drilling_hand")) {
    const double reach =
        d.hand_plan.start.norm() + 0.5 * std::hypot(d.hand_plan.width, d.hand_plan.height);
    if (reach > d.envelope.workspace_radius) {
      Table hand = root.table("drilling_hand");
      hand.reject("start", fmt::format("gives a region that reaches {:.3g} m from the middle; keep "
                                       "it within envelope.workspace_radius, {} [m]",
                                       reach, d.envelope.workspace_radius));
    }
  }
}

}  // namespace

BoneDefinition read_bone_definition(Table& root, std::string_view file_name,
                                    const fs::path* folder) {
  BoneDefinition d;
  d.protocol = kBoneDrilling;
  read_common(root, file_name, d);
  Table design = root.table("design");
  Table bone = root.table("bone");
  Table tools = root.table("tools");
  Table camera = root.table("camera");
  Table display = root.table("display");
  d.design = read_procedures(design);
  bone_schema().read(bone, d);
  d.simulator.tools = bone::read_tools(tools);
  d.simulator.camera = bone::microscope_schema().read(camera);
  if (root.has("pieces")) {
    Table pieces = root.table("pieces");
    d.simulator.world = bone::world_schema().read(pieces);
  }
  if (root.has("soft_tissue")) {
    Table soft = root.table("soft_tissue");
    d.simulator.soft_tissue = bone::read_soft_tissue(soft);
  }
  d.companions.dusty = root.has("dust");
  if (d.companions.dusty) {
    Table dust = root.table("dust");
    d.companions.dust = bone::dust_schema().read(dust);
  }
  if (root.has("bleeding")) {
    Table bleeding = root.table("bleeding");
    d.simulator.bleeding = bone::bleeding_schema().read(bleeding);
    d.companions.bleeds = true;
  }
  if (root.has("heat")) {
    Table heat = root.table("heat");
    d.simulator.heat = bone::heat_schema().read(heat);
  }
  d.drilling = read_drilling(root);
  if (d.drilling.second) {
    d.simulator.tube = d.drilling.second->tube;
    d.simulator.tube->at_tool.force_limit =
        std::min(d.drilling.force_limit, d.drilling.second->force_limit);
    Table second = root.table("second_hand");
    beside_schema().read(second, d);
  }
  Table drilling = root.table("drilling");
  recovery_schema().read(drilling, d);
  if (root.has("drilling_hand")) {
    Table hand = root.table("drilling_hand");
    d.hand_plan = subject::drilling_hand_schema().read(hand);
  }
  if (root.has("practice")) {
    Table practice = root.table("practice");
    bone_practice_schema().read(practice, d);
  }
  if (root.has("cavity")) {
    Table cavity = root.table("cavity");
    d.cavity = cavity_schema().read(cavity);
    if (d.placement.left_ear) {  // it is told for a right one
      d.cavity->offset_B.x() *= -1.0;
    }
  }
  read_osteotomy(root, d);
  if (d.beginning.planned_to > 0.0 && !d.cavity) {
    bone.reject("planned_to", "needs a cavity; add a table [cavity]");
  }
  read_sessions(root, d);
  if (root.has("curriculum")) {
    Table curriculum = root.table("curriculum");
    d.curriculum = bone::read_curriculum(curriculum, d.sources);
  }
  root.leave("analysis");  // of the rule on marked trials
  read_surgeons(root, d);
  bone_display_schema().read(display, d);
  read_sound(root, d, folder);
  read_given(root, d);
  if (root.has("feedback")) {
    Table feedback = root.table("feedback");
    feedback_schema().read(feedback, d);
  }
  check_scored(root, d);
  check_common(root, d);
  check_together(root, d);
  if (folder != nullptr && root.has("drilling_hand")) {
    reject_speed(root, d, "drilling_hand", "speed", d.hand_plan.speed);
  }
  d.tunable = root.tunable_keys();
  return d;
}

bool BoneDefinition::has_handpiece() const {
  constexpr auto kReverse = static_cast<std::size_t>(bone::Function::kReverse);
  const auto wears_or_feels = [](const bone::ToolSpec& tool) {
    const auto* burr = tool.as<bone::BurrTool>();
    return burr != nullptr && (burr->shaft || burr->burr.wear_volume > 0.0);
  };
  return std::any_of(simulator.tools.begin(), simulator.tools.end(), wears_or_feels) ||
         (simulator.tube && simulator.tube->shaft_length > 0.0) ||
         drilling.controls.buttons[kReverse] != 0 || !drilling.controls.keys[kReverse].empty();
}

int BoneDefinition::procedures_in(int session) const {
  const auto at = static_cast<std::size_t>(session - 1);
  return session >= 1 && at < procedures.size() ? procedures[at] : design.trials;
}

int BoneDefinition::procedures_before(int session, std::string_view group) const {
  int all = 0;
  for (int earlier = 1; earlier < session; ++earlier) {
    all += comes(earlier, group) ? procedures_in(earlier) : 0;
  }
  return all;
}

BoneDefinition of_case(const BoneDefinition& d, const std::string& name) {
  const bone::CurriculumCase* own = d.curriculum ? d.curriculum->case_of(name) : nullptr;
  if (own == nullptr || own->name != name) {
    throw InputError(fmt::format("{}: has no case '{}' in its curriculum", d.file_name, name));
  }
  BoneDefinition narrow = d;
  narrow.case_name = name;
  const auto bone =
      static_cast<std::size_t>(std::ranges::find(d.sources, own->bone) - d.sources.begin());
  const auto keep = [&](auto& by_bone) {
    if (bone < by_bone.size()) {
      by_bone = {by_bone[bone]};
    }
  };
  keep(narrow.sources);
  keep(narrow.bones);
  keep(narrow.charts);
  keep(narrow.nerve_distances);
  keep(narrow.hint_maps);
  keep(narrow.region_maps);
  return narrow;
}

BoneDefinition parse_bone_definition(std::string_view text, std::string_view file_name) {
  Table root = Table::parse(text, file_name);
  BoneDefinition d = read_bone_definition(root, file_name, nullptr);
  root.finish();
  return d;
}

bone::SimulatorParameters simulator_for(const BoneDefinition& d, const geometry::VoxelGrid& grid) {
  bone::SimulatorParameters p = d.simulator;
  p.pose_WB = pose_of(d.placement, grid);
  return p;
}

bone::CompanionParameters companions_for(const BoneDefinition& d, const geometry::VoxelGrid& grid) {
  bone::CompanionParameters p = d.companions;
  p.dust.voxel = grid.spacing;
  p.blood.voxel = grid.spacing;
  return p;
}

double smallest_burr(const BoneDefinition& d) {
  double radius = 1.0;
  for (const bone::ToolSpec& tool : d.simulator.tools) {
    const auto* burr = tool.as<bone::BurrTool>();
    radius = burr != nullptr ? std::min(radius, burr->radius()) : radius;
  }
  return radius;
}

}  // namespace haptrial::protocols
