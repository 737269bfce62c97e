#include "protocols/psychophysics/trials_protocol.h"

#include "core/base/error.h"
#include "core/record/rows/answer_rows.h"
#include "core/record/rows/object_rows.h"
#include "core/record/rows/trial_rows.h"
#include "protocols/psychophysics/defined_trials.h"
#include "protocols/psychophysics/definition/every_value.h"
#include "protocols/psychophysics/objects/object_files.h"
#include "protocols/psychophysics/trials_replay.h"

namespace haptrial::protocols {
namespace {

class TrialsProtocol final : public Protocol {
 public:
  std::string_view name() const override { return kTrials; }
  std::string_view synonym() const override { return "psychophysics"; }
  std::vector<std::string> virtual_tables() const override { return {"observer"}; }
  std::unique_ptr<Definition> read(Table& root, std::string_view file_name,
                                   const std::filesystem::path* folder) const override {
    auto definition = std::make_unique<StudiedDefinition>();
    read_trials_definition(root, file_name, *definition);
    for (sound::Cue& cue : definition->cues.cues) {
      if (folder != nullptr && cue.file.is_relative() && !cue.file.empty()) {
        cue.file = *folder / cue.file;
      }
    }
    definition->observer =
        read_observer(root, definition->questions, definition->stages, definition->hands);
    return definition;
  }
  void load(Definition& definition, const std::filesystem::path& folder) const override {
    auto& d = dynamic_cast<StudiedDefinition&>(definition);
    try {
      load_objects(d.objects, folder);
    } catch (const InputError& error) {
      throw InputError(d.file_name + ": " + error.what());
    }
    if (d.script) {
      load_script(*d.script, folder);
    }
    if (d.observer.script) {
      load_script(*d.observer.script, folder);
    }
    HandleText words = check_every_value(d);
    d.felt = std::move(words.lines);
    d.underdamped = std::move(words.warnings);
    for (const sound::Cue& cue : d.cues.cues) {
      sound::rendered(cue, 0);  // a file that cannot be played is a mistake of the definition
    }
  }
  std::vector<std::pair<record::Phase, std::string>> phases() const override {
    return {{record::Phase(record::kPresentedPhase), "a trial is presented and asked about"}};
  }
  record::TableList tables() const override {
    record::TableList tables = record::trial_tables();
    tables.push_back(&record::responses_table());
    tables.push_back(&record::table_of<record::AdaptationRow>());
    tables.push_back(&record::table_of<record::OutOfTimeRow>());
    tables.push_back(&record::table_of<record::ContactRow>());
    tables.push_back(&record::table_of<record::CursorRow>());
    tables.push_back(&record::table_of<record::TargetRow>());
    tables.push_back(&record::table_of<record::TouchedBodyRow>());
    tables.push_back(&record::table_of<record::MovingBodyRow>());
    tables.push_back(&record::table_of<record::LateWindowRow>());
    tables.push_back(&record::table_of<record::ObjectFileRow>());
    tables.push_back(&record::table_of<record::ArmRow>());
    return tables;
  }
  std::unique_ptr<Trials> trials(const Definition& definition,
                                 const SessionPlace& place) const override {
    return std::make_unique<DefinedTrials>(dynamic_cast<const StudiedDefinition&>(definition),
                                           place);
  }
  std::vector<std::string> blocks(const Definition& definition,
                                  const SessionPlace& place) const override {
    return blocks_of(dynamic_cast<const TrialsDefinition&>(definition), place);
  }
  void check_replayed(const Definition& definition,
                      const record::SessionReader& file) const override {
    const auto& d = dynamic_cast<const TrialsDefinition&>(definition);
    check_object_files(file, object_files(d.objects, d.cues.cues), "replay");
  }
  void replay(const ReplayRequest& request) const override { replay_trials(*this, request); }
};

}  // namespace

const Protocol& trials_protocol() {
  static const TrialsProtocol protocol;
  return protocol;
}

}  // namespace haptrial::protocols
