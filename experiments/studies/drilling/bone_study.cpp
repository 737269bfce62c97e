#include "experiments/studies/drilling/bone_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/exception_words.h"
#include "core/bone/record/drilling_types.h"
#include "core/record/read/session_reader.h"
#include "experiments/studies/drilling/drilling_curriculum.h"
#include "experiments/studies/drilling/drilling_learning.h"
#include "experiments/studies/drilling/drilling_preview.h"
#include "experiments/studies/drilling/drilling_study.h"
#include "experiments/studies/drilling/live_drilling.h"
#include "experiments/studies/drilling/trainee_pages.h"
#include "experiments/studies/drilling/tried_drilling.h"
#include "experiments/study/study_run.h"
#include "protocols/bone_drilling/bone_protocol.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

using analysis::drilling::Procedure;

/// The drillings of a running session.
class DrillingFigures final : public record::LiveFigures {
 public:
  DrillingFigures(const protocols::BoneDefinition& definition, fs::path resumed)
      : d_(definition),
        resumed_(std::move(resumed)),
        live_(procedure_setup(definition), definition.rate) {}

  void begin_pass(const record::PassRow& pass, std::int32_t) override {
    const auto bone = static_cast<std::size_t>(std::max(pass.trial, 1) - 1) % d_.bones.size();
    live_.begin(pass, d_.bones[bone], of_earlier_run(pass));
  }
  void rows(const record::Rows& batch) override {
    live_.add(batch.as<record::ToolRow>());
    live_.add(batch.as<record::RemovalRow>());
    live_.add(batch.as<record::CameraRow>());
    live_.add(batch.as<record::SplitRow>());
    live_.add(batch.as<record::PieceRow>());
    live_.add(batch.as<record::ScrewRow>());
  }
  void samples(std::span<const record::Sample> samples) override { live_.add(samples); }
  void finish() override { live_.finish(); }
  std::optional<record::LiveState> now() const override {
    const auto procedure = live_.now();
    return procedure ? std::optional(state_of(*procedure)) : std::nullopt;
  }
  std::vector<record::LiveState> done() const override {
    std::vector<record::LiveState> states;
    for (const DrilledProcedure& procedure : live_.procedures()) {
      states.push_back(state_of(procedure));
    }
    return states;
  }
  std::string trouble() const override { return trouble_.empty() ? live_.trouble() : trouble_; }

 private:
  std::shared_ptr<const Procedure> of_earlier_run(const record::PassRow& pass);

  const protocols::BoneDefinition& d_;
  fs::path resumed_;
  LiveDrilling live_;
  std::string trouble_;  // of the session's thread
};

/// Procedure of the file on the bone that the first pass after --resume goes on with.
std::shared_ptr<const Procedure> DrillingFigures::of_earlier_run(const record::PassRow& pass) {
  const fs::path resumed = std::exchange(resumed_, {});
  if (resumed.empty() || pass.practice || pass.attempt < 2) {
    return nullptr;
  }
  try {
    const record::SessionReader file(resumed);
    const auto passes = file.passes();
    const bool same_bone = std::any_of(passes.begin(), passes.end(), [&](const auto& row) {
      return row.trial == pass.trial && !row.practice && row.repetition == pass.repetition;
    });
    for (auto& procedure : load_procedures(file, procedure_setup(d_))) {
      if (same_bone && procedure.number == pass.trial) {
        return std::make_shared<const Procedure>(std::move(procedure));
      }
    }
  } catch (const std::exception& error) {  // nothing that a session should end for
    trouble_ = fmt::format("live figures leave out the passes before the session was resumed: {}",
                           sentence_of(error));
  }
  return nullptr;
}

class BoneStudy final : public Study {
 public:
  const protocols::Protocol& protocol() const override { return protocols::bone_drilling(); }
  void read_analysis(Table& root, const protocols::Definition* definition, bool) const override {
    const auto* d = dynamic_cast<const protocols::BoneDefinition*>(definition);
    read_drilling_learning(root, d);
    check_curriculum(root, d);
  }
  void check_loaded(const protocols::Definition& definition) const override {
    check_criteria(dynamic_cast<const protocols::BoneDefinition&>(definition));
  }
  std::optional<NextCase> next_case(const protocols::Definition& definition, const fs::path& folder,
                                    const std::vector<fs::path>& sessions) const override {
    const auto& d = dynamic_cast<const protocols::BoneDefinition&>(definition);
    return d.curriculum ? std::optional(next_case_of(d, folder, sessions)) : std::nullopt;
  }
  std::unique_ptr<record::LiveFigures> live_figures(const protocols::Definition& definition,
                                                    const fs::path& resumed) const override {
    return std::make_unique<DrillingFigures>(
        dynamic_cast<const protocols::BoneDefinition&>(definition), resumed);
  }
  std::vector<std::string> after_session(const protocols::Definition& definition,
                                         const fs::path& folder,
                                         const fs::path& file) const override {
    return page_after_session(dynamic_cast<const protocols::BoneDefinition&>(definition), folder,
                              file);
  }
  void add_preview(const protocols::Definition& definition, const PreviewRequest& request,
                   Preview& preview) const override {
    add_drilling_preview(dynamic_cast<const protocols::BoneDefinition&>(definition), request,
                         preview);
  }
  std::shared_ptr<TriedTrial> tried_trial(const protocols::Definition& definition,
                                          const PreviewRequest& request) const override {
    return tried_drilling(dynamic_cast<const protocols::BoneDefinition&>(definition), request);
  }
  void add_methods(const protocols::Definition& definition, std::uint64_t seed,
                   analysis::Document& document) const override {
    add_drilling_methods(dynamic_cast<const protocols::BoneDefinition&>(definition), seed,
                         document);
  }
  std::vector<std::string> analyze(const AnalysisRequest& request) const override {
    return analyze_drillings(request);
  }
  std::string next_step(const fs::path& folder) const override {
    return "haptrial replay " + session_files(folder).front().string();
  }
};

}  // namespace

const Study& bone_study() {
  static const BoneStudy study;
  return study;
}

}  // namespace haptrial::experiments
