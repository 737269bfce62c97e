#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/bone/record/bone_rows.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/tool_rows.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/display/bone_stage.h"
#include "protocols/interface/session_file.h"

namespace haptrial::protocols {

/// Rows of /burrs: those of a definition's tools that are burrs.
std::vector<record::BurrRow> burr_rows(std::span<const bone::ToolSpec> tools);

/// Row of a bone's procedure up to now, once its companions have settled. The dust of an earlier
/// run of the session is not in it.
/// @param pass  row of /trials
/// @param bone  row of /bones
record::ProcedureRow procedure_of(const BoneStage& stage, std::int32_t pass, std::int32_t bone);

/// Blood and heat up to now.
record::FieldRow field_of(const BoneStage& stage, std::int32_t pass);

/// Injuries of a session's trials, told while they happen: the first voxel of each vital structure
/// and each tear of soft tissue is an event of the file, and where a person drills a warning, so
/// that somebody at the console knows at once. Session's thread.
class NotedInjuries {
 public:
  /// @param definition  outlives this  @param real  a person drills
  NotedInjuries(const BoneDefinition& definition, bool real) : d_(definition), real_(real) {}

  /// Later rows are of this bone. @param number  how many bones the trial has had with it
  void begin_bone(const bone::BoneModel& model, std::int32_t number);

  void add(SessionFile& file, std::span<const record::RemovalRow> rows);
  void add(SessionFile& file, std::span<const record::TearRow> rows);

  std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }
  std::uint64_t tears() const { return tears_; }  // in this run of the session

 private:
  void note(SessionFile& file, const std::string& injury);
  std::string told(const record::TearRow& row) const;

  const BoneDefinition& d_;
  bool real_;
  const bone::BoneModel* model_{nullptr};
  std::int32_t number_{0};
  std::set<std::pair<std::int32_t, std::uint8_t>> opened_;  // numbers of bones, labels
  std::vector<std::string> warnings_;
  std::uint64_t tears_{0};
};

}  // namespace haptrial::protocols
