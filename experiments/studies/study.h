#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/statistics/design/sequential_looks.h"
#include "core/base/definition/table.h"
#include "core/record/rows/live_figures.h"
#include "experiments/studies/curve_analysis.h"
#include "experiments/study/next_case.h"
#include "experiments/study/study_files.h"
#include "protocols/interface/protocol.h"

namespace haptrial::analysis {
struct Document;
}

namespace haptrial::experiments {

/// A number of a report by its name.
struct NamedNumber {
  std::string name;
  double value{0.0};
};

/// Report of one simulated study.
struct SimulatedStudy {
  std::vector<NamedNumber> tests;     // p by which the report decides each test
  std::vector<NamedNumber> values;    // on the report's scale; that of a test has the test's name
  std::vector<std::string> failures;  // reasons, each as often as it came up
  std::uint64_t trials{0};            // of the study proper
  double hours{0.0};                  // in the lab, roughly
};

/// A study whose report can be had for simulated participants, one report for each seed. What a
/// kind of study gives to the simulation of power (experiments/power), and all that it needs to
/// know of it. Calls from several threads at once.
class StudySimulation {
 public:
  virtual ~StudySimulation() = default;

  /// Whether virtual participants differ from each other: a test over participants who do not says
  /// nothing of people.
  virtual bool people_differ() const = 0;
  /// A study at the level of responses: a function of the seed.
  /// @throws InputError if this definition can only be simulated in full
  virtual SimulatedStudy responses(std::uint64_t seed) const = 0;
  /// The same of sessions that were recorded. @param files  at least one
  virtual SimulatedStudy sessions(const std::vector<std::filesystem::path>& files) const = 0;
};

class Preview;
struct PreviewRequest;
class TriedTrial;

/// Request for the analysis of a folder of sessions of one study.
struct AnalysisRequest {
  std::filesystem::path folder;  // of the sessions
  StudyFiles files;
  std::filesystem::path out;  // for the report
  Pilots pilots{Pilots::kLeftOut};
  int threads{1};
  int paper{0};                      // width of figures as PDF [mm]; 0: none
  std::vector<std::string> planned;  // tests, in place of the definition's
  std::string reference;             // condition, likewise
  std::filesystem::path shares;      // file with the shares of a score of curves, likewise
};

/// A protocol together with what is computed from its sessions. It is one object without state.
class Study {
 public:
  virtual ~Study() = default;
  virtual const protocols::Protocol& protocol() const = 0;

  /// Reads what only the analysis needs of a definition; its problems are noted.
  /// @param definition  just read from the same tables, problems and all; null if that failed
  /// @param fresh       about to be used; else recorded already, and a fact whatever it says
  virtual void read_analysis(Table& root, const protocols::Definition* definition,
                             bool fresh) const {
    static_cast<void>(root);
    static_cast<void>(definition);
    static_cast<void>(fresh);
  }
  /// Checks what only a definition with all that it loads can tell. @throws InputError
  virtual void check_loaded(const protocols::Definition& definition) const {
    static_cast<void>(definition);
  }
  /// Sentences on what spoils the analysis without a word.
  virtual std::vector<std::string> analysis_warnings(
      const protocols::Definition& definition) const {
    static_cast<void>(definition);
    return {};
  }
  /// Figures while a session runs; null: none. @param resumed  file of the earlier run, or empty
  virtual std::unique_ptr<record::LiveFigures> live_figures(
      const protocols::Definition& definition, const std::filesystem::path& resumed) const {
    static_cast<void>(definition);
    static_cast<void>(resumed);
    return nullptr;
  }
  /// Does the work that a definition asks for when a session has ended. @param file  finished
  /// @param folder  of the definition. @returns lines for the terminal; never throws for what it
  /// cannot make, since the session is done
  virtual std::vector<std::string> after_session(const protocols::Definition& definition,
                                                 const std::filesystem::path& folder,
                                                 const std::filesystem::path& file) const {
    static_cast<void>(definition);
    static_cast<void>(folder);
    static_cast<void>(file);
    return {};
  }
  /// The case that comes next for a participant; nothing: the definition has no curriculum.
  /// @param folder  of the definition  @param sessions  finished, in their order
  virtual std::optional<NextCase> next_case(
      const protocols::Definition& definition, const std::filesystem::path& folder,
      const std::vector<std::filesystem::path>& sessions) const {
    static_cast<void>(definition);
    static_cast<void>(folder);
    static_cast<void>(sessions);
    return std::nullopt;
  }
  /// Adds the protocol's own parts of the page that shows an experiment before anybody runs it:
  /// what is seen and felt, how long stages last, how trials are distributed (experiments/preview).
  /// @throws InputError for a trial beyond the session
  virtual void add_preview(const protocols::Definition& definition, const PreviewRequest& request,
                           Preview& preview) const = 0;
  /// A trial that a pointer can try before anybody runs it (experiments/preview/tried_trial.h);
  /// null if the protocol's trials cannot be tried so. @param definition  outlives what comes back
  /// @throws InputError for a trial beyond the session
  virtual std::shared_ptr<TriedTrial> tried_trial(const protocols::Definition& definition,
                                                  const PreviewRequest& request) const {
    static_cast<void>(definition);
    static_cast<void>(request);
    return nullptr;
  }
  /// Adds stimuli, procedure, and the trials as planned to a methods section; by default the lines
  /// of `haptrial validate`. @param definition  from a session file, without what is loaded beside
  /// it  @param seed  of the study
  virtual void add_methods(const protocols::Definition& definition, std::uint64_t seed,
                           analysis::Document& document) const;
  /// Computes, and writes report, tables and figures. @returns lines for the terminal
  virtual std::vector<std::string> analyze(const AnalysisRequest& request) const = 0;
  /// How a study stands that may end before its last participant; nothing if it may not.
  virtual std::optional<analysis::SequentialResult> sequential(
      const AnalysisRequest& request) const {
    static_cast<void>(request);
    return std::nullopt;
  }
  /// The study's report for simulated participants, for the simulation of power.
  /// @param definition  outlives what comes back
  /// @param asked_in    file with [power]
  /// @param watched     name of the test whose power is asked for
  /// @throws InputError by default: it cannot be had
  virtual std::unique_ptr<StudySimulation> study_simulation(const protocols::Definition& definition,
                                                            const std::string& asked_in,
                                                            const std::string& watched) const;
  /// Command that goes on with the sessions of a dry run: "haptrial analyze DIR".
  virtual std::string next_step(const std::filesystem::path& folder) const {
    return "haptrial analyze " + folder.string();
  }
  /// How its curves of force are scored; nothing if its passes have none.
  virtual std::optional<CurveAnalysis> curves(const record::SessionInfo& session) const {
    static_cast<void>(session);
    return std::nullopt;
  }
};

}  // namespace haptrial::experiments
