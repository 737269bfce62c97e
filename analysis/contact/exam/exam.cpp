#include "analysis/contact/exam/exam.h"

#include <fmt/format.h>

#include <chrono>
#include <iterator>
#include <nlohmann/json.hpp>

#include "analysis/contact/evaluation/rendering_error.h"
#include "analysis/contact/exam/exam_bodies.h"
#include "analysis/contact/truth/true_contact.h"
#include "analysis/files/csv.h"
#include "analysis/files/new_folder.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/geometry/files/mesh_io.h"

namespace haptrial::evaluation {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using Json = nlohmann::ordered_json;
using Points = std::vector<Vector3d>;
using Clock = std::chrono::steady_clock;

constexpr int kFine = 4;  // edges of curved bodies: 0.5 to 0.8 mm
constexpr double kFriction = 0.3;
constexpr double kGrain = 1e-6;  // forces in files [N]

constexpr const char* kAbout = R"(# An exam for renderers of contact

A tool, a point, is led along eight bodies, each without friction and with a friction of 0.3.
The forces that are right are those of the god object: the tool hangs by a spring on a point that
never enters the body, and that friction holds while the force lies in its cone.

- exam.json names the cases: body, path, stiffness (N/m), friction, rate (Hz).
- bodies/NAME.obj is a closed mesh in metres.
- cases/CASE.csv has the path (x_m, y_m, z_m) and the true force on the tool (force_x_N, ...).

Answers are a folder with a file CASE.csv for each case, with the columns force_x_N, force_y_N,
force_z_N and as many rows as the path. `haptrial exam run` writes one for a renderer of haptrial, or
for any program that answers on a pipe; `haptrial exam score` compares answers with the truth.
)";

std::string words_in_a_row(std::string name) {
  std::ranges::replace(name, ' ', '-');
  return name;
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string case_csv(const Points& tool, const std::vector<TrueContact>& truth, double rate) {
  std::string text = "time_s,x_m,y_m,z_m,force_x_N,force_y_N,force_z_N\n";
  for (std::size_t i = 0; i < tool.size(); ++i) {
    const Vector3d& p = tool[i];
    const Vector3d& f = truth[i].force;
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{}\n",
                   static_cast<double>(i) / rate, p.x(), p.y(), p.z(), f.x(), f.y(), f.z());
  }
  return text;
}

std::string force_csv(const Points& force) {
  std::string text = "force_x_N,force_y_N,force_z_N\n";
  for (const Vector3d& f : force) {
    const Eigen::Array3d on_grid = (f.array() / kGrain).round() * kGrain + 0.0;  // no "-0"
    fmt::format_to(std::back_inserter(text), "{:.6f},{:.6f},{:.6f}\n", on_grid.x(), on_grid.y(),
                   on_grid.z());
  }
  return text;
}

Points vectors_of(const analysis::CsvTable& table, const char* const (&names)[3]) {
  const std::vector<double> x = table.numbers(table.column(names[0]));
  const std::vector<double> y = table.numbers(table.column(names[1]));
  const std::vector<double> z = table.numbers(table.column(names[2]));
  Points points;
  for (std::size_t i = 0; i < x.size(); ++i) {
    points.emplace_back(x[i], y[i], z[i]);
  }
  return points;
}

constexpr const char* kPlaces[] = {"x_m", "y_m", "z_m"};
constexpr const char* kForces[] = {"force_x_N", "force_y_N", "force_z_N"};

ExamCase read_case(const fs::path& folder, const nlohmann::json& said) {
  ExamCase one;
  one.name = said.at("name");
  one.task = {folder / std::string(said.at("body")), said.at("stiffness_N_per_m"),
              said.at("friction"), said.at("rate_Hz")};
  const auto table = analysis::CsvTable::load(folder / std::string(said.at("path")));
  one.tool = vectors_of(table, kPlaces);
  one.truth = vectors_of(table, kForces);
  return one;
}

}  // namespace

void write_exam(const fs::path& folder) {
  const ContactTask task;
  exchange::NewFolder out(folder);
  Json cases = Json::array();
  for (const ExamBody& body : exam_bodies()) {
    const std::string file = "bodies/" + words_in_a_row(body.name) + ".obj";
    out.write(file, geometry::encode_mesh(mesh_of(body.body, kFine), geometry::MeshFormat::kObj));
    const Points tool = there_and_back(body);
    for (const double friction : {0.0, kFriction}) {
      const std::string name = words_in_a_row(body.name) + (friction > 0.0 ? "-friction" : "");
      const std::string path = "cases/" + name + ".csv";
      out.write(path, case_csv(tool, true_contacts(body.body, tool, task.stiffness, friction),
                               task.rate));
      cases.push_back({{"name", name},
                       {"body", file},
                       {"path", path},
                       {"stiffness_N_per_m", task.stiffness},
                       {"friction", friction},
                       {"rate_Hz", task.rate}});
    }
  }
  out.write("exam.json",
            Json{{"exam", "contact of a point"}, {"version", 1}, {"cases", cases}}.dump(2) + "\n");
  out.write("README.md", kAbout);
  out.write("LICENCE", "SPDX-License-Identifier: MIT\nCopyright (c) 2026 the haptrial authors\n");
  out.publish();
}

std::vector<ExamCase> read_exam(const fs::path& folder) {
  const fs::path file = folder / "exam.json";
  std::vector<ExamCase> exam;
  try {
    const auto said = nlohmann::json::parse(file_text(file));
    for (const auto& one : said.at("cases")) {
      exam.push_back(read_case(folder, one));
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: {}; allowed: what haptrial exam make writes", file.string(),
                                 error.what()));
  }
  return exam;
}

ExamAnswers sit_exam(Candidate& candidate, const std::string& renderer,
                     const std::vector<ExamCase>& exam) {
  ExamAnswers answers{renderer, {}, true};
  for (const ExamCase& one : exam) {
    ExamAnswers::Case answer;
    const Clock::time_point start = Clock::now();
    candidate.begin(one.task);
    answer.preparation = seconds_since(start);
    candidate.start(one.tool.front());
    std::vector<double> ticks;
    for (std::size_t i = 0; i < one.tool.size(); ++i) {
      const Clock::time_point tick = Clock::now();
      answer.force.push_back(candidate.tick(static_cast<double>(i) / one.task.rate, one.tool[i]));
      ticks.push_back(seconds_since(tick));
    }
    const TickTimes times = tick_times(ticks);
    answer.median_tick = times.median;
    answer.worst_tick = times.worst;
    answers.cases.push_back(std::move(answer));
  }
  return answers;
}

void write_answers(const ExamAnswers& answers, const FailureMap& ridges,
                   const std::vector<ExamCase>& exam, const fs::path& folder) {
  exchange::NewFolder out(folder);
  Json costs = Json::object();
  for (std::size_t i = 0; i < exam.size(); ++i) {
    const ExamAnswers::Case& answer = answers.cases[i];
    out.write(exam[i].name + ".csv", force_csv(answer.force));
    costs[exam[i].name] = {{"preparation_s", answer.preparation},
                           {"median_tick_s", answer.median_tick},
                           {"worst_tick_s", answer.worst_tick}};
  }
  out.write("failures.csv", failure_csv({ridges}));
  out.write("answers.json", Json{{"renderer", answers.renderer}, {"costs", costs}}.dump(2) + "\n");
  out.publish();
}

ExamAnswers read_answers(const fs::path& folder, const std::vector<ExamCase>& exam) {
  ExamAnswers answers{fs::weakly_canonical(folder).filename().string(), {}, false};
  const fs::path file = folder / "answers.json";
  nlohmann::json said;
  try {
    if (fs::exists(file)) {
      said = nlohmann::json::parse(file_text(file));
      answers.renderer = said.at("renderer");
      answers.costs_known = true;
    }
    for (const ExamCase& one : exam) {
      const fs::path path = folder / (one.name + ".csv");
      ExamAnswers::Case answer;
      answer.force = vectors_of(analysis::CsvTable::load(path), kForces);
      if (answer.force.size() != one.tool.size()) {
        throw InputError(fmt::format("{}: {} forces; allowed: {}, one for each row of the path",
                                     path.string(), answer.force.size(), one.tool.size()));
      }
      if (answers.costs_known) {
        const auto& cost = said.at("costs").at(one.name);
        answer.preparation = cost.at("preparation_s");
        answer.median_tick = cost.at("median_tick_s");
        answer.worst_tick = cost.at("worst_tick_s");
      }
      answers.cases.push_back(std::move(answer));
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError(
        fmt::format("{}: {}; allowed: what haptrial exam run writes", file.string(), error.what()));
  }
  return answers;
}

}  // namespace haptrial::evaluation
