#include <malloc.h>

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "analysis/exchange/score.h"
#include "analysis/tutoring/link_report.h"
#include "core/base/error.h"
#include "experiments/command/arguments.h"
#include "experiments/command/curves/curve_commands.h"
#include "experiments/command/subcommand.h"
#include "experiments/plan/audit/stated_and_done.h"
#include "experiments/plan/audit/study_methods.h"
#include "experiments/studies/recorded_kinds.h"
#include "experiments/studies/registry.h"
#include "experiments/study/study_files.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

struct AnalyzeOptions : CurveOptions {
  std::string folder;
  std::string shares;
  bool pilots{false};
  std::optional<int> paper;
  std::optional<int> jobs;
};

/// Folder for the report of a folder of sessions: that of its pilots must not replace the study's.
fs::path report_folder(const fs::path& folder, Pilots pilots) {
  return pilots == Pilots::kAlone ? folder / "pilots" : folder;
}

void print_report(const std::vector<std::string>& lines, const fs::path& out) {
  for (const std::string& line : lines) {
    fmt::print("{}\n", line);
  }
  fmt::print("report: {}\n", (fs::absolute(out) / "report.html").lexically_normal().string());
}

/// A report on the link, where sessions had two coupled hands, in any protocol.
void report_link(const AnalysisRequest& request) {
  namespace link = analysis::link;
  const auto study =
      link::link_study(request.files.files, request.files.first.seed, request.threads);
  if (study) {
    link::write_link(*study, request.out);
    fmt::print("link: {}\n", (fs::absolute(request.out) / "link.html").lexically_normal().string());
  }
}

/// @throws InputError for a width that no page has
int paper_width(const AnalyzeOptions& options) {
  constexpr int kNarrowest = 40, kWidest = 250;  // [mm]
  return options.paper ? checked_number("--paper", *options.paper, kNarrowest, kWidest) : 0;
}

/// The options that replace parts of the definition.
std::vector<std::string> given_instead(const AnalyzeOptions& options) {
  std::vector<std::string> given = options.planned;
  if (!options.reference.empty()) {
    given.push_back("reference " + options.reference);
  }
  if (!options.shares.empty()) {
    given.push_back("shares of " + options.shares);
  }
  return given;
}

/// Studies without curves have no shares.
void check_shares(const AnalyzeOptions& options, const record::SessionInfo& session) {
  if (!options.shares.empty() && !study_of(session).curves(session)) {
    throw InputError(
        fmt::format("--shares is given, but the passes of {} have no force to recall; "
                    "leave it out",
                    session.definition_name));
  }
}

int analyze_sessions(const AnalyzeOptions& options, Pilots pilots, int threads, int paper) {
  mallopt(M_ARENA_MAX,
          1);  // what is read of thousands of files stays; what was read with is reused
  AnalysisRequest request;
  request.folder = options.folder;
  request.files = with_recorded_kinds(
      options.folder, [&] { return study_files(options.folder, pilots, protocol_of); });
  check_shares(options, request.files.first);
  if (pilots == Pilots::kLeftOut) {
    note_analysis(options.folder, given_instead(options));
  }
  request.out = report_folder(options.folder, pilots);
  request.pilots = pilots;
  request.threads = threads;
  request.paper = paper;
  request.planned = options.planned;
  request.reference = options.reference;
  request.shares = options.shares;
  std::vector<std::string> lines;
  try {
    lines = with_recorded_kinds(options.folder,
                                [&] { return study_of(request.files.first).analyze(request); });
  } catch (...) {
    if (pilots == Pilots::kLeftOut) {
      note_failed_analysis(options.folder);
    }
    throw;
  }
  print_report(lines, request.out);
  report_link(request);
  if (!analysis::scores().empty()) {
    const fs::path table = request.out / "own_scores.csv";
    fmt::print("{} own scores: {}\n", analysis::write_scores(request.files.files, table),
               fs::absolute(table).lexically_normal().string());
  }
  return 0;
}

bool is_import(const AnalyzeOptions& options) { return options.folder.empty(); }

void require_one_source(const AnalyzeOptions& options) {
  const int sources = !options.folder.empty() + !options.curves.empty() + !options.table.empty();
  if (sources != 1) {
    throw InputError("give exactly one of DIR, --curves and --table");
  }
}

/// Options that the source needs and that only others take.
void check_source(const AnalyzeOptions& options) {
  require_one_source(options);
  const bool curves = !options.curves.empty();
  const bool table = !options.table.empty();
  const auto need = [](const char* name, const std::string& value, const char* by) {
    if (value.empty()) {
      throw InputError(fmt::format("{} is missing; {} needs it", name, by));
    }
  };
  const auto allow = [](bool allowed, const char* name, bool given, const char* with) {
    if (!allowed && given) {
      throw InputError(fmt::format("{} is given without {}; leave it out", name, with));
    }
  };
  if (curves) {
    need("--conditions", options.conditions, "--curves");
  }
  if (curves || table) {
    need("--out", options.out, curves ? "--curves" : "--table");
  }
  allow(curves, "--conditions", !options.conditions.empty(), "--curves");
  constexpr const char* kImport = "--curves or --table";
  allow(is_import(options), "--out", !options.out.empty(), kImport);
  allow(is_import(options), "--definition", !options.definition.empty(), kImport);
  allow(is_import(options), "--column", !options.columns.empty(), kImport);
  allow(is_import(options), "--factor", !options.factors.empty(), kImport);
  allow(!is_import(options), "--shares", !options.shares.empty(), "a folder of sessions");
  allow(!is_import(options), "--pilots", options.pilots, "a folder of sessions");
  if (is_import(options) && holds_sessions(options.out)) {  // whose report this would replace
    throw InputError(
        fmt::format("{}: --out holds session files; choose another folder", options.out));
  }
}

int analyze(const AnalyzeOptions& options) {
  const int threads = checked_jobs(options.jobs);
  const int paper = paper_width(options);
  check_source(options);
  const bool import = is_import(options);
  const Pilots pilots = options.pilots ? Pilots::kAlone : Pilots::kLeftOut;
  if (!import) {
    return analyze_sessions(options, pilots, threads, paper);
  }
  print_report(analyze_curves(options, paper, threads), options.out);
  return 0;
}

}  // namespace

void add_analyze(CLI::App& app, int& status) {
  CLI::App* sub = subcommand(
      app, "analyze", "Score and test the sessions of a folder and write the report",
      "haptrial analyze out/force_training-001",
      {"scores.csv, statistics.json, figures and report.html in DIR", "guide-analyst.md"});
  add_stated_and_done();
  add_study_methods();
  auto& o = options_of<AnalyzeOptions>(*sub, status, analyze);
  sub->add_option("DIR", o.folder, "Folder of session files (.h5)");
  sub->add_flag("--pilots", o.pilots,
                "Analyse only the pilot sessions of DIR; the report goes into DIR/pilots");
  sub->add_option("--curves", o.curves,
                  "Folder of curves from another system (.csv), in place of DIR");
  sub->add_option("--conditions", o.conditions,
                  "Table of the trials of --curves and their conditions (.csv)");
  sub->add_option("--table", o.table,
                  "Table of all samples from another system (.csv), in place of DIR");
  sub->add_option("--out", o.out, "Folder for the report of --curves or --table");
  sub->add_option("--definition", o.definition,
                  "Definition by which --curves or --table are scored (default: as shipped)");
  sub->add_option("--column", o.columns,
                  "Name of a column of --curves or --table, as in subject=Participant; may be "
                  "repeated")
      ->allow_extra_args(false);
  sub->add_option("--factor", o.factors,
                  "Column of a factor, in place of condition; may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--planned", o.planned,
                  "Planned test in place of the definition's, 'A < B', 'A > B' or 'A != B'; may be "
                  "repeated")
      ->allow_extra_args(false);
  sub->add_option("--reference", o.reference, "Reference condition in place of the definition's");
  sub->add_option("--shares", o.shares,
                  "File of judge fit with shares of the score, in place of the definition's");
  sub->add_option(
      "--paper", o.paper,
      "Width [mm] of figures for a paper, such as 85: PDF and SVG in 8 pt, without titles "
      "(default: none are written)");
  sub->add_option("--jobs", o.jobs, kJobsHelp);
}

}  // namespace haptrial::experiments
