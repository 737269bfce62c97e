// haptrial judge: sheets on which curves are judged blindly, and what the judgements say of the
// score.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <set>

#include "analysis/files/staging.h"
#include "analysis/force_training/judge/judged_curves.h"
#include "analysis/force_training/study/session_recalls.h"
#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "experiments/command/arguments.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/curve_analysis.h"
#include "experiments/studies/registry.h"
#include "experiments/study/study_files.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

constexpr const char* kJudgingKey = "judging.key.csv";
constexpr const char* kShares = "judged-shares.toml";

struct JudgePrepareOptions {
  std::string folder;
  std::string out;
  int curves{60};
  double repeated{0.2};
  std::optional<std::uint64_t> seed;
};

struct JudgeFitOptions {
  std::string folder;
  std::vector<std::string> judges;
};

/// A recall without its curves.
struct Found {
  fs::path file;
  record::PassRow pass;
};

analysis::ScoreParameters scoring_of(const record::SessionInfo& info) {
  const auto curves = study_of(info).curves(info);
  if (!curves) {
    throw InputError(
        fmt::format("{}: its passes have no force to recall; allowed: sessions of force training",
                    info.definition_name));
  }
  return curves->scoring;
}

std::vector<Found> recalls_in(const std::vector<fs::path>& files,
                              const analysis::ScoreParameters& scoring) {
  std::vector<Found> found;
  for (const fs::path& file : files) {
    const record::SessionReader reader(file);
    const std::vector<record::PassRow> passes = reader.passes();
    for (const auto& scored : analysis::session_recalls(reader, scoring, 1).scored) {
      found.push_back({file, passes[scored.pass]});
    }
  }
  return found;
}

analysis::JudgedRecall recall_of(const Found& found, const analysis::ScoreParameters& scoring) {
  const record::SessionReader reader(found.file);
  const auto places = analysis::path_places(reader, found.pass.block, scoring);
  const auto run = analysis::run_samples(reader, found.pass);
  const auto curves = analysis::recall_curves(*run, reader.info().rate, places.get());
  return {found.file.filename().string(), reader.info().subject, found.pass.trial,
          analysis::score_recall_in_detail(curves->target, curves->applied, scoring)};
}

analysis::SheetOptions sheet_options(const JudgePrepareOptions& options, std::uint64_t seed) {
  constexpr int kMostCurves = 1000;
  analysis::SheetOptions sheets;
  sheets.curves =
      static_cast<std::size_t>(checked_number("--curves", options.curves, 2, kMostCurves));
  if (!(options.repeated >= 0.0 && options.repeated <= 1.0)) {
    throw InputError(fmt::format("--repeated is {}; allowed: 0 to 1", options.repeated));
  }
  sheets.repeated = options.repeated;
  sheets.seed = options.seed.value_or(seed);
  return sheets;
}

void must_be_absent(const fs::path& path) {
  if (fs::exists(path)) {
    throw InputError(fmt::format(
        "{}: exists already; remove it to prepare anew, but judgements of the old sheets are then "
        "lost",
        path.string()));
  }
}

int judge_prepare(const JudgePrepareOptions& options) {
  const fs::path study(options.folder), out(options.out);
  const StudyFiles files = study_files(study, Pilots::kLeftOut, protocol_of);
  const analysis::SheetOptions sheets = sheet_options(options, files.first.seed);
  must_be_absent(study / kJudgingKey);
  must_be_absent(out);
  const analysis::ScoreParameters scoring = scoring_of(files.first);
  const std::vector<Found> found = recalls_in(files.files, scoring);
  if (found.empty()) {
    throw InputError(fmt::format("{}: no session holds a recall", study.string()));
  }
  std::vector<analysis::JudgedRecall> recalls;
  for (const std::size_t place : analysis::shuffled_recalls(found.size(), sheets)) {
    recalls.push_back(recall_of(found[place], scoring));
  }
  const analysis::Staging staging(out), beside(study);
  const auto pages = analysis::judging_sheets(recalls, sheets, files.first.simulated);
  for (std::size_t i = 0; i < pages.size(); ++i) {
    staging.write(fmt::format("sheet-{}.html", i + 1), pages[i]);
  }
  staging.write("judgements.csv", analysis::judging_table(recalls, sheets));
  beside.write(kJudgingKey, analysis::judging_key(recalls, sheets));
  beside.publish();
  staging.publish();
  fmt::print("{} on {}, by seed {}: {}\n", counted(recalls.size(), "curve", "curves"),
             counted(pages.size(), "sheet", "sheets"), sheets.seed, out.string());
  fmt::print("key, which no judge may see: {}\n", (study / kJudgingKey).string());
  return 0;
}

int judge_fit(const JudgeFitOptions& options) {
  const fs::path study(options.folder);
  const record::SessionInfo info =
      record::SessionReader(files_of(study, Pilots::kLeftOut).front()).info();
  const auto key = analysis::read_judging_key(study / kJudgingKey);
  std::vector<std::string> names;
  std::vector<std::vector<double>> judgements;
  for (const std::string& file : options.judges) {
    names.push_back(fs::path(file).stem().string());
    judgements.push_back(analysis::read_judgements(file, key));
  }
  if (std::set<std::string>(names.begin(), names.end()).size() < names.size()) {
    throw InputError("two tables have the same name; name each judge's table after the judge");
  }
  const analysis::Judging judging = analysis::judging_of(key, names, judgements, info.seed);
  const analysis::Document report = analysis::judging_report(judging, info.simulated);
  const analysis::Staging staging(study);
  staging.write("judging.html", analysis::to_html(report));
  staging.write("judging.md", analysis::to_markdown(report));
  const bool predicts = judging.skill && judging.skill->predicts;
  if (predicts) {
    staging.write(kShares, analysis::judged_weights(*judging.skill));
  } else {
    fs::remove(study / kShares);  // those of other tables
  }
  staging.publish();
  fmt::print("{}\n", judging.skill ? judging.skill->verdict
                                   : fmt::format("The shares are not defined, because {}.",
                                                 judging.skill.because()));
  if (predicts) {
    fmt::print("shares: {}\n", (study / kShares).string());
  }
  fmt::print("report: {}\n", (study / "judging.html").string());
  return 0;
}

void add_judge_prepare(CLI::App& judge, int& status) {
  CLI::App* sub =
      subcommand(judge, "prepare", "Make sheets of shuffled curves and a table to fill in",
                 "haptrial judge prepare out/force_training-001 --out out/for-judges");
  auto& o = options_of<JudgePrepareOptions>(*sub, status, judge_prepare);
  sub->add_option("DIR", o.folder, "Folder of sessions of force training (.h5)")->required();
  sub->add_option("--out", o.out, "New folder for the judges")->required();
  sub->add_option("--curves", o.curves, with_default("Number of curves that are drawn", o.curves));
  sub->add_option("--repeated", o.repeated,
                  with_default("Share of them that comes twice", o.repeated));
  sub->add_option("--seed", o.seed, "Seed of draw and order (default: the study's)");
}

void add_judge_fit(CLI::App& judge, int& status) {
  CLI::App* sub =
      subcommand(judge, "fit", "Compare completed tables and fit the shares of the score to them",
                 "haptrial judge fit smith.csv li.csv --study out/force_training-001");
  auto& o = options_of<JudgeFitOptions>(*sub, status, judge_fit);
  sub->add_option("TABLE", o.judges, "Completed tables (.csv), each with its judge's name")
      ->required();
  sub->add_option("--study", o.folder, "Folder of the study that was prepared")->required();
}

}  // namespace

void add_judge(CLI::App& app, int& status) {
  CLI::App* judge =
      subcommand(app, "judge", "Judge recalled curves blindly, and fit the score to the judgements",
                 "haptrial judge prepare out/force_training-001 --out out/for-judges");
  judge->require_subcommand(1);
  add_judge_prepare(*judge, status);
  add_judge_fit(*judge, status);
}

}  // namespace haptrial::experiments
