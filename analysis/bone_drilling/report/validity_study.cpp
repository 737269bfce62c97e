#include "analysis/bone_drilling/report/validity_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "analysis/bone_drilling/report/field_section.h"
#include "analysis/bone_drilling/report/learned_quantities.h"
#include "analysis/bone_drilling/report/phase_section.h"
#include "analysis/bone_drilling/report/ratings.h"
#include "analysis/bone_drilling/report/session_files.h"
#include "analysis/bone_drilling/report/validity.h"
#include "analysis/bone_drilling/report/validity_figures.h"
#include "analysis/bone_drilling/report/validity_json.h"
#include "analysis/bone_drilling/report/validity_report.h"
#include "analysis/document/figure_gnuplot.h"
#include "analysis/files/staging.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/parallel.h"
#include "core/record/read/marked_trials.h"
#include "core/record/read/session_reader.h"

namespace haptrial::analysis::drilling {
namespace {

namespace fs = std::filesystem;

/// Results, nerve monitor, hints and forbidden regions of every session.
struct Sessions {
  std::vector<ProcedureSummary> procedures;
  std::vector<NerveProcedure> nerves;
  std::vector<HintProcedure> hints;
  std::vector<CrossingProcedure> crossings;
  std::vector<SessionFiles> files;
};

SessionFiles files_of(const record::SessionReader& reader,
                      const std::vector<ProcedureSummary>& procedures) {
  SessionFiles files;
  files.session = reader.path().filename().string();
  const auto passes = counted_passes(reader);
  for (const ProcedureSummary& p : procedures) {
    files.bones[{passes.at(p.number).back().pass.condition, p.number}] = p.bone;
  }
  if (reader.has(record::table_of<record::HintLimitRow>())) {
    files.limits = reader.rows<record::HintLimitRow>();
  }
  return files;
}

template <class T>
void move_to(std::vector<T>& all, std::vector<T>& some) {
  std::move(some.begin(), some.end(), std::back_inserter(all));
}

Sessions sessions_of(const ValidityStudy& study) {
  StudyBones bones;
  std::vector<Sessions> by_file(study.files.size());
  in_groups(study.files.size(), 1, study.threads, [&] {
    return [&](std::size_t first, std::size_t) {
      const record::SessionReader reader(study.files[first]);
      const ProcedureSetup setup = study.setup(reader);
      const std::set<int> marked = record::trials_left_out(reader);
      Sessions& own = by_file[first];
      for (const Procedure& p : load_procedures(reader, setup, &bones)) {
        if (!marked.contains(p.number)) {
          own.procedures.push_back(summarize(p, study.metrics, bones));
        }
      }
      own.nerves = load_nerves(reader, setup.group);
      own.hints = load_hints(reader, own.procedures);
      own.crossings = load_crossings(reader, own.procedures);
      own.files = {files_of(reader, own.procedures)};
      std::erase_if(own.nerves, [&](const auto& nerve) { return marked.contains(nerve.number); });
    };
  });
  Sessions all;
  for (Sessions& file : by_file) {
    move_to(all.procedures, file.procedures);
    move_to(all.nerves, file.nerves);
    move_to(all.hints, file.hints);
    move_to(all.crossings, file.crossings);
    move_to(all.files, file.files);
  }
  return all;
}

/// Empty unless procedures are of several cases of a curriculum.
std::vector<std::string> remarks_on_cases(const std::vector<ProcedureSummary>& procedures) {
  std::set<std::string> cases;
  for (const ProcedureSummary& p : procedures) {
    cases.insert(p.case_name);
  }
  if (cases.size() < 2) {
    return {};
  }
  return {
      fmt::format("Means are over the procedures of all cases: {}. Cases differ in their bones; "
                  "metrics.csv has "
                  "the case of each procedure.",
                  fmt::join(cases, ", "))};
}

std::string structure_of(const ValidityStudy& study,
                         const std::vector<ProcedureSummary>& procedures) {
  if (!study.structure.empty()) {
    return study.structure;
  }
  std::map<std::string, std::size_t> removals;
  for (const ProcedureSummary& p : procedures) {
    for (const NearRemovals& near : p.near) {
      removals[near.structure] += near.removals.size();
    }
  }
  const std::string published = "chorda tympani";
  if (const auto at = removals.find(published); at != removals.end() && at->second > 0) {
    return published;
  }
  std::string most;
  for (const auto& [name, count] : removals) {
    if (count > 0 && (most.empty() || count > removals[most])) {
      most = name;
    }
  }
  return most;
}

/// Leaves out what raters said of procedures that are not analysed, such as those of a participant
/// who was excluded or has withdrawn, and says so.
template <class Row>
void leave_out_others(std::vector<Row>& rows, std::span<const ProcedureSummary> procedures,
                      const char* what, std::vector<std::string>& remarks) {
  std::set<std::string> sessions;
  const auto is_left_out = [&](const Row& row) {
    const bool analysed = std::ranges::any_of(procedures, [&](const ProcedureSummary& p) {
      return p.session == row.session && p.number == row.procedure;
    });
    if (!analysed) {
      sessions.insert(row.session);
    }
    return !analysed;
  };
  const std::size_t before = rows.size();
  std::erase_if(rows, is_left_out);
  if (rows.size() < before) {
    remarks.push_back(fmt::format("{} of procedures that are not analysed, in {}, left out",
                                  counted(before - rows.size(), what), fmt::join(sessions, ", ")));
  }
}

}  // namespace

ValidityResult analyze(const ValidityStudy& study) {
  ValidityResult result;
  result.title = study.title;
  result.bins = study.metrics.bins;
  result.pictures = study.pictures;
  Sessions sessions = sessions_of(study);
  result.procedures = std::move(sessions.procedures);
  result.nerves = std::move(sessions.nerves);
  result.hints = std::move(sessions.hints);
  result.crossings = std::move(sessions.crossings);
  result.remarks = remarks_on_files(sessions.files);
  std::ranges::move(remarks_on_cases(result.procedures), std::back_inserter(result.remarks));
  result.hint_effects = hint_effects(result.hints, result.procedures);
  if (result.procedures.empty()) {
    throw InputError("no session holds a drilling, so there is nothing to analyse");
  }
  const auto regions = add_region_scores(result.procedures, study.plan.expert_groups);
  std::vector<Rating> ratings;
  if (!study.ratings.empty() && fs::exists(study.ratings)) {
    ratings = load_ratings(study.ratings);
    leave_out_others(ratings, result.procedures, "rating", result.remarks);
  }
  if (!study.checklist.empty()) {
    result.checked.checklist = load_checklist(study.checklist);
    result.checked.rows = load_checked(study.checked, result.checked.checklist);
    leave_out_others(result.checked.rows, result.procedures, "checklist", result.remarks);
  }
  const auto region_test = region_label_test(result.procedures, study.plan.expert_groups);
  result.validity = validity(result.procedures, regions, ratings, study.plan, region_test);
  result.structure = structure_of(study, result.procedures);
  result.learned = learned_study(learned_quantities(result.procedures, study.learning.outcomes),
                                 study.learning, study.learning_names);
  return result;
}

void write_validity(const ValidityResult& result, const fs::path& folder, int paper,
                    const std::vector<FindingList>& own) {
  const Staging staging(folder);
  staging.write("metrics.csv", metrics_csv(result.procedures));
  staging.write("statistics.json", validity_json(result, own));
  if (!result.nerves.empty()) {
    staging.write("nerves.csv", nerves_csv(result.nerves));
  }
  if (has_field(result.procedures)) {
    staging.write("heat_and_blood.csv", field_csv(result.procedures));
  }
  if (!result.hints.empty()) {
    staging.write("hints.csv", hints_csv(result.hints));
  }
  if (!result.crossings.empty()) {
    staging.write("crossings.csv", crossings_csv(result.crossings));
  }
  if (is_divided(result)) {
    staging.write("phases.csv", phases_csv(result.procedures));
  }
  std::vector<Figure> figures = validity_figures(result);
  std::ranges::move(learning_figures(result.learned, result.validity.simulated),
                    std::back_inserter(figures));
  write_findings(own, staging, figures);
  draw_figures(figures, staging.path(), paper);
  std::vector<Drawing> drawings;
  for (const StudyPicture& picture : result.pictures) {
    drawings.push_back(drawing_of(picture, result.validity.simulated));
    staging.write(picture.name + ".svg", drawings.back().svg);
  }
  for (const Figure& figure : figures) {
    drawings.push_back({figure, file_text(staging.path() / (figure.name + ".svg"))});
  }
  Document report = validity_report(result, drawings);
  add_findings(report, own, drawings);
  staging.write("report.html", to_html(report));
  staging.write("report.md", to_markdown(report));
  staging.publish();
}

}  // namespace haptrial::analysis::drilling
