#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/bone/curriculum/curriculum.h"
#include "core/bone/hint/hint_watch.h"
#include "core/bone/model/bone_model.h"
#include "core/bone/nerve/nerve_distances.h"
#include "core/bone/nerve/nerve_setup.h"
#include "core/bone/region/forbidden_region.h"
#include "core/bone/simulator/companions.h"
#include "core/bone/simulator/simulator.h"
#include "core/render/gl/quality_steps.h"
#include "core/sound/drill_sound.h"
#include "core/subject/drilling/cavity_chart.h"
#include "core/subject/drilling/drilling_chart.h"
#include "core/subject/drilling/drilling_hand.h"
#include "core/subject/drilling/drilling_surgeon.h"
#include "core/subject/drilling/fragment_plan.h"
#include "core/subject/drilling/osteotomy_hand.h"
#include "protocols/bone_drilling/definition/controls.h"
#include "protocols/bone_drilling/definition/placement.h"
#include "protocols/bone_drilling/definition/second_hand.h"
#include "protocols/definition/definition.h"

namespace haptrial::protocols {

/// How a device becomes a tool on the bone.
struct DrillingParameters {
  Controls controls;
  /// Which way the handle runs, from the tip to the hand, in the frame of the device's orientation;
  /// in W where the device senses none. Any length but 0.
  Eigen::Vector3d handle{Eigen::Vector3d::UnitY()};
  /// The device's workspace is this many times as large as the scene's: motions are scaled down by
  /// it, forces are not. > 0
  double scale{1.0};
  double force_limit{10.0};                    // of what the device is asked for > 0 [N]
  double time_limit{900.0};                    // of a drilling > 0 [s]
  std::optional<SecondHandParameters> second;  // at a second device
};

/// Range of densities that the grey of a slice spans: `low` and below is black, `high` white.
struct SliceWindow {
  double low{0.0};
  double high{1.0};  // > low
};

inline constexpr const char* kBoneDrilling = "bone_drilling";  // its name in [experiment]
inline constexpr const char* kMonitor = "monitor";  // in conditions: "monitor on", "monitor off"
inline constexpr const char* kTutor = "tutor";  // likewise, where the definition says who is led

/// A procedure of a study, by its place in it.
struct ProcedurePlace {
  int trial{1};        // of the session, from 1; practice: 0
  int participant{0};  // from 0
  int session{1};      // of the participant, from 1
};

/// Where procedures begin instead of at intact bone.
struct BoneBeginning {
  int procedure{1};          // of recorded sessions among the bones >= 1
  std::optional<double> at;  // time of it >= 0; default: its end [s]
  std::string at_phase;      // that it begins to work on then, in place of a time; empty: none
  double planned_to{0.0};    // share of the cavity's depth that is gone by the plan, 0 to 1
};

/// An experiment of drillings (`protocol = "bone_drilling"`), read from a definition file and valid
/// as a whole. A trial is one procedure on one bone.
struct BoneDefinition : Definition {
  std::vector<std::string>
      sources;  // of bones: "procedural temporal", "procedural mandible", files, sessions
  std::uint64_t bone_seed{1};     // of procedural ones
  std::optional<double> spacing;  // of voxels [m]; default: as the source has it
  BoneBeginning beginning;
  BonePlacement placement;
  bool mirror{false};                   // left and right of all bones are exchanged
  bone::SimulatorParameters simulator;  // but for the pose
  bone::CompanionParameters companions;
  DrillingParameters drilling;
  subject::DrillingHandParameters hand_plan;   // of the virtual hand
  Eigen::Vector3d beside{0.003, 0.003, 0.0};   // the burr, where its other one holds the tube [m]
  std::map<std::string, double> group_skills;  // of virtual surgeons, 0 to 1; none: all are alike
  std::vector<int> procedures;  // of each session, where the definition describes sessions
  std::optional<bone::Curriculum> curriculum;  // nothing: bones come in turn
  std::string case_name;                       // of it, which the session is of; empty: none
  double practice{0.0};                        // before the first procedure, of people only [s]
  std::optional<subject::CavityParameters> cavity;  // that is asked for
  std::optional<subject::FragmentPlan> osteotomy;   // likewise, of a cut and its fragment
  std::optional<subject::OsteotomyHandParameters> osteotomy_hand;  // of the virtual hand, with it
  /// Virtual participants are surgeons (drilling_surgeon.h) and not hands that drill; skill is that
  /// of their group.
  std::optional<subject::SurgeonParameters> surgeon;
  bool sound_card{false};  // whether a live session is heard
  sound::SpectrumTable sound_table;
  sound::ThinBone thin_bone;
  sound::SpectrumTable vibration_table;
  double vibration_gain{0.0};              // >= 0
  std::optional<render::Quality> quality;  // of the participant's screen; none: by frame time
  bool surroundings{true};                 // soft tissue and drapes are drawn around the field
  std::string opened_text{"You opened the {structure} after {time}"};
  std::string time_text{"{time} left"};
  std::string plan_text{
      "green: planned, removed   blue: planned, left   orange: beyond the plan   red: vital"};
  bool slices{false};  // as of a scan stand beside the picture
  SliceWindow slice_window;
  bool stereo{false};
  double eye_distance{0.02};  // between the eyes, in the scene >= 0 [m]
  int stills{0};              // of stages of the cavity, which can be called up; 0: none
  std::optional<nerve::NerveSetup> nerves;     // that are watched
  std::optional<hint::HintSetup> hints;        // to who drills
  std::optional<bone::RegionSetup> forbidden;  // regions that burrs are kept out of
  std::vector<TunableKey> tunable;             // keys that a pilot may change while it runs
  bool trainee_page{false};                    // written after a session, beside its file
  std::string experts_study;                   // folder that the page compares with; empty: nobody
  std::string score_file;                      // of a score that the page applies; empty: none
  std::string phases_file;                     // of phases, likewise; empty: none
  std::string checklist_file;                  // likewise; empty: none
  std::vector<std::string> absent_files;       // keys and files of those four that are not there
  /// Bones by source; procedures take them in turn. There are none if only a text was parsed: a
  /// session file has its bones in it.
  std::vector<std::shared_ptr<const bone::BoneModel>> bones;
  std::vector<std::shared_ptr<const subject::DrillingChart>> charts;  // (bones) with a cavity

  std::vector<std::shared_ptr<const nerve::NerveDistances>> nerve_distances;  // (bones) if watched
  std::vector<std::shared_ptr<const hint::HintMap>> hint_maps;      // (bones) if there are hints
  std::vector<std::shared_ptr<const bone::RegionMap>> region_maps;  // (bones) if any is forbidden

  std::vector<DeviceArm> arms() const override { return {drilling.second ? 2U : 1U, {envelope}}; }
  /// Whether something bleeds or warms up.
  bool has_field() const { return simulator.heat || !simulator.bleeding.structures.empty(); }
  /// Whether a shaft is felt, a burr wears or can be reversed.
  bool has_handpiece() const;
  /// Whether the tools of two hands push each other, which /tool_contact has.
  bool tools_meet() const { return simulator.tube && simulator.tube->at_tool.stiffness > 0.0; }
  /// Whether a participant hears the nerve monitor in a procedure, sees hints, or is kept out of
  /// forbidden regions.
  bool hears_nerves(const ProcedurePlace& place) const;
  bool sees_hints(const ProcedurePlace& place) const;
  bool has_regions(const ProcedurePlace& place) const;
  /// Condition of a procedure: one of design.conditions.
  std::string condition(const ProcedurePlace& place) const;
  /// Procedures of a session, from 1, and of all sessions before it to which a group comes.
  int procedures_in(int session) const;
  int procedures_before(int session, std::string_view group) const;

  int sessions() const override { return design.sessions; }
  int trials_in(int session) const override { return procedures_in(session); }
  std::string case_of_session() const override { return case_name; }
  PedalUse pedal_use() const override;
  std::vector<ButtonUse> button_uses() const override;
  std::vector<std::string> description() const override;
  std::vector<std::string> warnings() const override;
  std::vector<std::string> left_out_of_dry_runs() const override;
  double longest(int trials) const override { return trials * drilling.time_limit; }
  bool has_target() const override { return false; }
  bool is_heard() const override { return sound_card; }
  /// Electromyograms of the nerve monitor.
  std::vector<stream::SideStream> side_streams() const override;
  std::uint32_t functions_of(const std::vector<int>& held) const override {
    return functions_of_keys(drilling.controls, held);
  }
};

/// Whether a source of bones is a recorded session.
bool is_session(std::string_view source);

/// Definition from the text that a session file keeps, without bones.
BoneDefinition parse_bone_definition(std::string_view text, std::string_view file_name);
/// Definition from a table that others read on, and whose problems are still to be thrown; without
/// bones.
/// @param folder  of the file, for tables that it names; null: they are not read
BoneDefinition read_bone_definition(Table& root, std::string_view file_name,
                                    const std::filesystem::path* folder);

/// Reads [nerve_monitor], [hints] and [forbidden], what participants may be given while they drill,
/// and the conditions of procedures that follow from them.
void read_given(Table& root, BoneDefinition& definition);

/// The definition of a session of one case of its curriculum: with the case's bone alone.
/// @throws InputError if it has no such case
BoneDefinition of_case(const BoneDefinition& definition, const std::string& name);

/// The simulator of a procedure: the definition's, around a bone.
bone::SimulatorParameters simulator_for(const BoneDefinition& definition,
                                        const geometry::VoxelGrid& grid);
bone::CompanionParameters companions_for(const BoneDefinition& definition,
                                         const geometry::VoxelGrid& grid);

/// The radius of the smallest burr of a definition; 1 m without any. [m]
double smallest_burr(const BoneDefinition& definition);

}  // namespace haptrial::protocols
