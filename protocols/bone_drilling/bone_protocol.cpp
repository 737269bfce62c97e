#include "protocols/bone_drilling/bone_protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/bone/hint/hint_rows.h"
#include "core/bone/model/distance_field.h"
#include "core/bone/nerve/nerve_rows.h"
#include "core/bone/record/bone_rows.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/tool_rows.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/common_tables.h"
#include "core/sound/wav.h"
#include "core/subject/drilling/work_row.h"
#include "protocols/bone_drilling/bone_replay.h"
#include "protocols/bone_drilling/bone_trials.h"
#include "protocols/bone_drilling/display/bone_display.h"
#include "protocols/bone_drilling/display/bone_pictures.h"
#include "protocols/bone_drilling/display/bone_sound.h"
#include "protocols/bone_drilling/load_bones.h"
#include "protocols/bone_drilling/nerve_page.h"
#include "protocols/bone_drilling/replayed_signals.h"
#include "protocols/bone_drilling/tuning_page.h"

namespace haptrial::protocols {
namespace {

/// Pictures and sound of a drilling that is simulated again.
class DrillingOutputs {
 public:
  DrillingOutputs(const ReplayRequest& request, const BoneReplay& replay)
      : request_(request),
        replay_(replay),
        hints_(record::SessionReader(request.file)),
        chimes_(replay.definition().hints && replay.definition().hints->sound),
        every_(replay.rate() / request.fps) {
    if (!request.sound.empty()) {
      const BoneDefinition& d = replay.definition();
      const int trial = request.trial != 0 ? request.trial : replay.trials().front();
      if (d.nerves) {
        nerves_ = std::make_unique<ReplayedNerves>(request.file, d.nerves->monitor, trial,
                                                   sound::DrillSound::kRate);
      }
      sound_.emplace(request.sound, replay.rate(), d.sound_table, d.thin_bone, 1, false,
                     [this](std::span<float> part) { mix(part); });
    }
  }
  DrillingOutputs(const DrillingOutputs&) = delete;
  DrillingOutputs& operator=(const DrillingOutputs&) = delete;
  bool any() const { return request_.pictures || sound_; }

  void watch(std::uint64_t tick, std::uint64_t sequence, const bone::DrillingView& without_hints,
             const std::shared_ptr<const BoneStage>& stage) {
    if (stage != stage_) {
      stage_ = stage;
      began_ = tick;
      vital_ = bone::vital_structures(*stage->model);
      renderer_.reset();
      probe_.emplace(stage);
      if (request_.pictures) {
        renderer_ = std::make_unique<BoneRenderer>(replay_.definition(), stage);
      }
    }
    bone::DrillingView seen = hints_.with(without_hints, sequence, vital_);
    seen.elapsed = static_cast<double>(tick - began_) / replay_.rate();
    seen.time_limit = replay_.definition().drilling.time_limit;
    seen.progress = std::min(1.0, seen.elapsed / seen.time_limit);
    constexpr std::uint64_t kProbeEvery = 20;  // ticks
    if (nerves_) {
      nerves_->tick(sequence);
    }
    if (sound_) {
      injury_.hear(seen);
      thickness_ = tick % kProbeEvery == 0 ? probe_->under(seen) : thickness_;
      sound_->add(sound_of(seen, stage->simulator->tools(), thickness_));
    }
    if (renderer_ && static_cast<double>(tick) >= next_) {
      next_ += every_;
      request_.picture(renderer_->draw(seen));
      ++count_;
    }
  }

  void finish() {
    renderer_.reset();
    if (sound_) {
      sound_->finish();
      request_.tell("sound: " + request_.sound.string());
    }
    if (count_ > 0) {
      request_.tell(fmt::format("{} pictures", count_));
    }
  }

 private:
  /// Mixes in the sounds that are heard with the drill.
  void mix(std::span<float> part) noexcept {
    if (nerves_) {
      nerves_->mix(part);
    }
    if (chimes_) {
      hints_.mix(part);
    }
    injury_.mix(part);
  }

  const ReplayRequest& request_;
  const BoneReplay& replay_;
  ReplayedHints hints_;
  bool chimes_;                     // a hint that begins was heard
  std::vector<std::string> vital_;  // structures of the bone
  double every_;                    // ticks from picture to picture
  double next_{0.0};
  std::uint64_t began_{0};  // tick on which the bone was new
  int count_{0};
  InjuryChime injury_;
  std::unique_ptr<ReplayedNerves> nerves_;  // heard with the drill; null: nobody watched any
  std::optional<sound::SoundTrack> sound_;
  std::shared_ptr<const BoneStage> stage_;
  std::unique_ptr<BoneRenderer> renderer_;
  std::optional<ThicknessProbe> probe_;
  double thickness_{1.0};  // [m]
};

void tell_verdict(const ReplayRequest& request, const ReplayVerdict& verdict) {
  if (!verdict.difference.empty()) {
    throw RunError(fmt::format("{}: trial {} differs from the recording when simulated again: {}",
                               request.file.string(), verdict.trial, verdict.difference));
  }
  request.tell(fmt::format(
      "trial {}: the same bone, {} ticks in {}, {} voxels emptied, {}checksum {:016x}{}",
      verdict.trial, verdict.ticks, counted(verdict.passes, "pass", "passes"), verdict.emptied,
      verdict.tears > 0 ? counted(verdict.tears, "tear", "tears") + " of soft tissue, " : "",
      verdict.checksum, verdict.whole ? "" : "; an unfinished pass has no checksum"));
}

class BoneDrilling final : public Protocol {
 public:
  std::string_view name() const override { return kBoneDrilling; }
  std::vector<std::string> virtual_tables() const override {
    return {"drilling_hand", "osteotomy_hand", "virtual_surgeons"};
  }
  std::unique_ptr<Definition> read(Table& root, std::string_view file_name,
                                   const std::filesystem::path* folder) const override {
    return std::make_unique<BoneDefinition>(read_bone_definition(root, file_name, folder));
  }
  void load(Definition& definition, const std::filesystem::path& folder) const override {
    load_bones(dynamic_cast<BoneDefinition&>(definition), folder);
  }
  std::vector<std::pair<record::Phase, std::string>> phases() const override {
    return {{record::kDrillingPhase, "bone is drilled"}};
  }
  record::TableList tables() const override {
    record::TableList tables =
        record::with_tables(record::drilling_tables(), record::nerve_tables());
    tables = record::with_tables(tables, record::hint_tables());
    tables.push_back(&record::table_of<record::TearRow>());
    tables.push_back(&record::table_of<record::LedRow>());
    tables.push_back(&record::table_of<record::SecondHandRow>());
    tables.push_back(&record::table_of<record::ToolContactRow>());
    tables.push_back(&record::table_of<record::BurrRow>());
    tables.push_back(&record::table_of<record::HandpieceRow>());
    tables.push_back(&record::table_of<record::OpeningRow>());
    tables.push_back(&record::table_of<record::FieldRow>());
    tables.push_back(&record::table_of<record::PieceRow>());
    tables.push_back(&record::table_of<record::ScrewRow>());
    tables.push_back(&record::table_of<record::WorkRow>());
    tables.push_back(&record::table_of<record::CrossingRow>());
    tables.push_back(&record::table_of<record::TuningRow>());
    return tables;
  }
  std::unique_ptr<Definition> of_case(const Definition& definition,
                                      const std::string& name) const override {
    return std::make_unique<BoneDefinition>(
        protocols::of_case(dynamic_cast<const BoneDefinition&>(definition), name));
  }
  AuxiliaryPages auxiliary_pages(const Definition& definition) const override {
    const auto& d = dynamic_cast<const BoneDefinition&>(definition);
    AuxiliaryPages pages{std::make_shared<TuningPage>(d)};
    if (d.nerves) {
      pages.push_back(std::make_shared<NervePage>());
    }
    return pages;
  }
  std::unique_ptr<Trials> trials(const Definition& definition,
                                 const SessionPlace& place) const override {
    return std::make_unique<BoneTrials>(dynamic_cast<const BoneDefinition&>(definition), place);
  }
  void replay(const ReplayRequest& request) const override;
};

void BoneDrilling::replay(const ReplayRequest& request) const {
  if (const char* phase = record::kDrillingPhase.name();
      !request.phase.empty() && request.phase != phase) {
    throw InputError(fmt::format("--phase is '{}'; allowed: {}", request.phase, phase));
  }
  const BoneReplay replay(request.file);
  DrillingOutputs outputs(request, replay);
  const std::vector<int> all = replay.trials();
  if (all.empty()) {
    throw InputError(fmt::format("{}: holds no trials", request.file.string()));
  }
  const int first = request.trial != 0 ? request.trial : all.front();
  const int last = request.trial != 0 || outputs.any() ? first : all.back();
  for (int trial = first; trial <= last; ++trial) {
    const auto ticks = static_cast<double>(replay.ticks(trial));
    BoneReplay::Watch watch;
    if (outputs.any()) {
      watch = [&](std::uint64_t tick, std::uint64_t sequence, const bone::DrillingView& seen,
                  const std::shared_ptr<const BoneStage>& stage) {
        outputs.watch(tick, sequence, seen, stage);
        constexpr std::uint64_t kBetween = 100;  // ticks
        if (tick % kBetween == 0) {
          request.progress(static_cast<double>(tick), ticks, fmt::format("trial {}", trial),
                           replay.rate());
        }
      };
    }
    tell_verdict(request, replay.run(trial, watch));
  }
  outputs.finish();
}

}  // namespace

const Protocol& bone_drilling() {
  static const BoneDrilling protocol;
  return protocol;
}

}  // namespace haptrial::protocols
