#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "analysis/contact/exam/exam_score.h"
#include "analysis/document/figure_gnuplot.h"
#include "analysis/document/finding.h"
#include "analysis/document/finding_json_internal.h"
#include "analysis/files/new_folder.h"
#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial::evaluation {
namespace {

using analysis::Document;
using analysis::Finding;
using analysis::FindingList;
using analysis::FindingRow;
using analysis::FindingTable;

/// Answers are written to a millionth: what is below it tells nothing.
Finding number(const char* name, const char* title, double value, const char* unit) {
  return {.name = name,
          .title = title,
          .value = 1e-6 * std::round(1e6 * value) + 0.0,
          .unit = unit,
          .csv = name,
          .form = analysis::JsonForm::kPlain};
}

Finding count(const char* name, const char* title, std::size_t value) {
  return {.name = name,
          .title = title,
          .value = value,
          .csv = name,
          .form = analysis::JsonForm::kPlain};
}

/// A row begins with the renderer, the case and the verdict.
FindingRow begun_row(const ExamScore& score, std::size_t i, const ExamCase& one) {
  return {
      {.name = "renderer", .value = score.answers.renderer, .form = analysis::JsonForm::kAbsent},
      {.name = "case", .title = "case", .value = one.name, .form = analysis::JsonForm::kPlain},
      {.name = "verdict",
       .title = "verdict",
       .value = name_of(score.cases[i].verdict),
       .form = analysis::JsonForm::kPlain}};
}

/// The shape of a soft body, in millimetres.
FindingRow shape_row_of(const ExamScore& score, std::size_t i, const ExamCase& one) {
  const SoftScore& s = score.cases[i].soft;
  FindingRow row = begun_row(score, i, one);
  std::ranges::move(
      FindingRow{count("tetrahedra", "tetrahedra", s.tetrahedra),
                 number("displacement_error_rms", "error, RMS", 1e3 * s.root_mean_square, "mm"),
                 number("displacement_error_mean", "mean", 1e3 * s.mean, "mm"),
                 number("displacement_error_worst", "worst", 1e3 * s.worst, "mm"),
                 number("displacement_rms", "true displacement, RMS", 1e3 * s.moved, "mm"),
                 number("momentum_off", "momentum off by", s.momentum_off, ""),
                 count("samples_inside_out", "samples inside out", s.inside_out)},
      std::back_inserter(row));
  return row;
}

FindingRow row_of(const ExamScore& score, std::size_t i, const ExamCase& one) {
  const CaseScore& s = score.cases[i];
  FindingRow row = begun_row(score, i, one);
  std::ranges::move(
      FindingRow{
          number("error_rms", "error, RMS", s.force.root_mean_square, "N"),
          number("error_mean", "mean", s.force.mean_norm, "N"),
          number("error_worst", "worst", s.force.worst, "N"),
          number("error_below_10_hz", "below 10 Hz", s.bands.slow, "N"),
          number("error_10_to_100_hz", "10 to 100 Hz", s.bands.middle, "N"),
          number("error_above_100_hz", "above", s.bands.fast, "N"),
          number("share_beyond_7_percent", "off by more than 7 %", s.noticeable.beyond_low, ""),
          number("energy_given", "energy given", s.energy, "J"),
          number("energy_given_by_truth", "by the truth", s.true_energy, "J"),
          count("ticks_lost", "ticks lost", s.lost), count("ticks_stuck", "ticks stuck", s.stuck)},
      std::back_inserter(row));
  if (one.task.is_rigid()) {
    row.push_back(
        number("torque_error_rms", "torque error, RMS", s.torque.root_mean_square, "N·m"));
    row.push_back(number("torque_mean", "mean torque", s.torque.mean_force, "N·m"));
  }
  return row;
}

std::string file_name(std::string renderer) {
  for (char& c : renderer) {
    c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '-';
  }
  return renderer;
}

/// Answers are told apart by the name that files and findings have, so that a second renderer of
/// one name would take the place of the first.
void check_names(const std::vector<ExamScore>& scores) {
  for (std::size_t i = 0; i < scores.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const std::string& first = scores[j].answers.renderer;
      const std::string& second = scores[i].answers.renderer;
      if (file_name(first) == file_name(second)) {
        throw InputError(
            fmt::format("the renderers '{}' and '{}' would both be written as {}; allowed: names "
                        "that differ in letters or digits (renderer in answers.json, which exam "
                        "run --name sets)",
                        first, second, file_name(first)));
      }
    }
  }
}

FindingList findings_of(const ExamScore& score, const std::vector<ExamCase>& exam) {
  FindingList list{.name = file_name(score.answers.renderer), .heading = score.answers.renderer};
  FindingTable table{"cases", "Cases"}, shapes{"shapes", "Shapes"};
  for (std::size_t i = 0; i < exam.size(); ++i) {
    table.rows.push_back(row_of(score, i, exam[i]));
    shapes.rows.push_back(shape_row_of(score, i, exam[i]));
  }
  list.tables.push_back(std::move(table));
  if (exam.front().task.is_soft()) {
    list.tables.push_back(std::move(shapes));
  }
  if (score.ridge) {
    analysis::Figure figure = failure_figure(*score.ridge);
    figure.name = "ridge-" + list.name;
    list.figures.push_back(std::move(figure));
  }
  return list;
}

double root_mean_square(const ExamScore& score) {
  double sum = 0.0;
  for (const CaseScore& one : score.cases) {
    sum += one.force.root_mean_square * one.force.root_mean_square;
  }
  return std::sqrt(sum / static_cast<double>(score.cases.size()));
}

std::string microseconds(const ExamScore& score, double ExamAnswers::Case::*time) {
  if (!score.answers.costs_known) {
    return "not known";
  }
  const auto& cases = score.answers.cases;
  const auto most = std::ranges::max_element(cases, {}, time);
  return fmt::format("{:.1f}", 1e6 * (*most).*time);
}

/// Root mean square of the displacement error as a share of the true displacement, over the cases
/// that have one.
double shape_off(const ExamScore& score) {
  double off = 0.0, moved = 0.0;
  for (const CaseScore& one : score.cases) {
    off += one.soft.root_mean_square * one.soft.root_mean_square;
    moved += one.soft.moved * one.soft.moved;
  }
  return moved > 0.0 ? std::sqrt(off / moved) : 0.0;
}

/// The fewest tetrahedra that a case moved in a second, at its median tick, in millions.
std::string tetrahedra_a_second(const ExamScore& score) {
  if (!score.answers.costs_known) {
    return "not known";
  }
  double fewest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < score.cases.size(); ++i) {
    fewest = std::min(fewest, static_cast<double>(score.cases[i].soft.tetrahedra) /
                                  score.answers.cases[i].median_tick);
  }
  return fmt::format("{:.2f}", 1e-6 * fewest);
}

std::string stable_words(const std::vector<StabilityCell>& cells) {
  if (cells.empty()) {
    return "not known";
  }
  return fmt::format("{} of {}", std::ranges::count_if(cells, &StabilityCell::stable),
                     cells.size());
}

/// The columns of the summary that this kind of exam alone has.
std::vector<std::pair<std::string, std::string>> own_columns(const ExamScore& score,
                                                             ExamKind kind) {
  if (kind == ExamKind::kSoft) {
    return {{"shape off by (%)", fmt::format("{:.1f}", 100.0 * shape_off(score))},
            {"tetrahedra (10⁶/s)", tetrahedra_a_second(score)}};
  }
  if (kind == ExamKind::kPoint) {
    return {{"ridges right", score.ridge
                                 ? fmt::format("{} of {}", score.ridge->count(RidgeOutcome::kRight),
                                               score.ridge->cells.size())
                                 : "not known"},
            {"stable with a hand", stable_words(score.answers.stability)}};
  }
  return {};
}

void add_summary(Document& document, const std::vector<ExamScore>& scores, ExamKind kind) {
  std::vector<std::string> heading;
  std::vector<std::vector<std::string>> rows;
  for (const ExamScore& score : scores) {
    std::vector<std::pair<std::string, std::string>> cells{
        {"renderer", score.answers.renderer},
        {"error, RMS (N)", fmt::format("{:.4f}", root_mean_square(score))}};
    for (const ExamVerdict verdict : verdicts_of(kind)) {
      cells.emplace_back(name_of(verdict), fmt::format("{}", score.count(verdict)));
    }
    std::ranges::move(own_columns(score, kind), std::back_inserter(cells));
    cells.emplace_back("slowest median tick (us)",
                       microseconds(score, &ExamAnswers::Case::median_tick));
    cells.emplace_back("worst tick (us)", microseconds(score, &ExamAnswers::Case::worst_tick));
    heading.clear();
    rows.emplace_back();
    for (auto& [title, value] : cells) {
      heading.push_back(title);
      rows.back().push_back(value);
    }
  }
  document.table(heading, rows);
}

constexpr const char* kSoftMethod =
    "Soft bodies are led there and back by a tool that holds some of their vertices, or by forces, "
    "in 2 s at 1 kHz; a free block is pushed and let fly. The truth is the body at rest, by "
    "neo-Hookean elements continued to cells of no size, within 1.5 % of the displacement and 3 % "
    "of the force. A case is inside out if a tetrahedron is, on a sample; loses momentum if a free "
    "body's, or its angular momentum, is off by more than a twentieth; and is misshapen if the "
    "displacements are off by more than a tenth, in the root mean square. ";

constexpr const char* kRigidMethod =
    "A rigid tool hangs on the hand by springs of 500 N/m and 0.3 N·m/rad and is led into bodies "
    "that leave a convex space free, there and back at 1 kHz, without friction. The truth is the "
    "place of least energy in the springs, exact to a nanometre. Energy counts force and torque. ";

constexpr const char* kPointMethod =
    "A tool, a point, is led along eight bodies, without friction and with 0.3, at 500 N/m and "
    "1 kHz, there and back. The truth is the god object with Coulomb's friction, exact on plane "
    "faces, spheres and cylinders. Ridges are the source's Figure 65 as a map. "
    "A hand of 50 g and 1 N·s/m that presses the plane with 2 N at 36 stiffnesses, frictions and "
    "rates counts as stable if it moves less than 0.1 mm across it in the last of 3 s; in 18 of "
    "them its damping exceeds K T / 2, which makes a sampled wall passive. ";

constexpr const char* kVerdicts =
    "A case pops through if a force of more than 0.2 N is missing or "
    "points into the body on a tick, sticks if there is a force of more than 0.2 N in the air, "
    "gives "
    "energy if the hand gains more than a hundredth of the energy that it stored on the way, and "
    "is "
    "noticeable if more than a twentieth of the samples are off by more than 7 % of the force. The "
    "first of these that holds is the verdict. Times of "
    "ticks are those of the computer that ran the renderer; another program's include its pipe.";

const char* method_of(ExamKind kind) {
  return kind == ExamKind::kPoint   ? kPointMethod
         : kind == ExamKind::kRigid ? kRigidMethod
                                    : kSoftMethod;
}

}  // namespace

std::vector<std::string> score_lines(const std::vector<ExamScore>& scores) {
  std::vector<std::string> lines;
  for (const ExamScore& score : scores) {
    lines.push_back(fmt::format("{}: {} of {} cases right, error {:.4f} N (RMS)",
                                score.answers.renderer, score.count(ExamVerdict::kRight),
                                score.cases.size(), root_mean_square(score)));
    if (score.cases.front().soft.tetrahedra > 0) {
      lines.back() += fmt::format(", shape off by {:.1f} %", 100.0 * shape_off(score));
    }
  }
  return lines;
}

void write_scores(const std::vector<ExamScore>& scores, const std::vector<ExamCase>& exam,
                  const std::filesystem::path& folder) {
  check_names(scores);
  exchange::NewFolder out(folder);
  std::vector<FindingList> lists;
  std::vector<FindingTable> tables;
  for (const ExamScore& score : scores) {
    lists.push_back(findings_of(score, exam));
    std::ranges::copy(lists.back().tables, std::back_inserter(tables));
  }
  out.write("scores.csv",
            analysis::findings_csv(
                tables, {{"renderer", "renderer"}, {"case", "case"}, {"verdict", "verdict"}}));
  out.write("scores.json", analysis::json_of(lists).dump(2) + "\n");
  const std::filesystem::path place = out.place("report.html").parent_path();
  std::vector<analysis::Drawing> drawings;
  for (const FindingList& list : lists) {
    analysis::draw_figures(list.figures, place);
    for (const analysis::Figure& figure : list.figures) {
      drawings.push_back({figure, file_text(place / (figure.name + ".svg"))});
    }
  }
  Document document;
  document.title = "Exam of renderers";
  const ExamKind kind = exam.front().task.kind();
  add_summary(document, scores, kind);
  document.paragraph(std::string(method_of(kind)) + kVerdicts);
  analysis::add_findings(document, lists, drawings);
  out.write("report.html", analysis::to_html(document));
  out.publish();
}

}  // namespace haptrial::evaluation
