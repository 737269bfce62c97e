#include "analysis/contact/exam/exam.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <chrono>
#include <iterator>
#include <nlohmann/json.hpp>

#include "analysis/contact/evaluation/rendering_error.h"
#include "analysis/contact/exam/exam_bodies.h"
#include "analysis/contact/exam/exam_tools.h"
#include "analysis/contact/truth/true_contact.h"
#include "analysis/files/csv.h"
#include "analysis/files/new_folder.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/geometry/files/mesh_io.h"

namespace haptrial::evaluation {
namespace {

namespace fs = std::filesystem;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr int kFine = 4;  // edges of curved bodies: 0.5 to 0.8 mm
constexpr double kFriction = 0.3;
constexpr double kGrain = 1e-6;  // forces in files [N]

constexpr const char* kAboutTools = R"(# An exam for renderers of rigid tools

A rigid tool hangs on the hand by two springs, of its place and of its turn, and is led into three
bodies that leave a convex space free, so that the place where it rests is known exactly. There is
no friction.

- exam.json names the cases: body, tool, path, stiffness (N/m), turning stiffness (N m/rad), rate (Hz).
- bodies/NAME.obj and tools/NAME.obj are closed meshes in metres, each in its own frame.
- cases/CASE.csv has the poses of the hand in the body's frame (x_m, y_m, z_m, unit quaternion qw, qx,
  qy, qz), and the true force on it (force_x_N, ...) and torque about the tool's origin (torque_x_Nm, ...).

Answers are a folder with a file CASE.csv for each case, with the columns of forces and torques and
as many rows as the path. `haptrial exam run` writes one for `rigid-tool`, or for any program that
answers on a pipe; `haptrial exam score` compares answers with the truth.
)";

constexpr const char* kAboutPoints = R"(# An exam for renderers of contact

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

/// Numbers of a row of a path: the place, and the turn of a rigid tool.
std::string pose_words(const Isometry3d& pose, bool rigid) {
  const Vector3d p = pose.translation();
  const std::string place = fmt::format("{},{},{}", p.x(), p.y(), p.z());
  if (!rigid) {
    return place;
  }
  const Eigen::Quaterniond q(pose.linear());
  return fmt::format("{},{},{},{},{}", place, q.w(), q.x(), q.y(), q.z());
}

constexpr std::array kPlaces{"x_m", "y_m", "z_m"};
constexpr std::array kTurns{"qw", "qx", "qy", "qz"};
constexpr std::array kForces{"force_x_N", "force_y_N", "force_z_N"};
constexpr std::array kTorques{"torque_x_Nm", "torque_y_Nm", "torque_z_Nm"};

std::string case_csv(const ExamCase& one) {
  const bool rigid = one.task.is_rigid();
  std::string text =
      fmt::format("time_s,{}{},{}{}\n", fmt::join(kPlaces, ","),
                  rigid ? fmt::format(",{}", fmt::join(kTurns, ",")) : "", fmt::join(kForces, ","),
                  rigid ? fmt::format(",{}", fmt::join(kTorques, ",")) : "");
  for (std::size_t i = 0; i < one.tool.size(); ++i) {
    const Vector3d &f = one.truth[i].force, &m = one.truth[i].torque;
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{}",
                   static_cast<double>(i) / one.task.rate, pose_words(one.tool[i], rigid), f.x(),
                   f.y(), f.z());
    text += rigid ? fmt::format(",{},{},{}\n", m.x(), m.y(), m.z()) : "\n";
  }
  return text;
}

void add_on_grid(std::string& text, const Vector3d& v) {
  const Eigen::Array3d on_grid = (v.array() / kGrain).round() * kGrain + 0.0;  // no "-0"
  fmt::format_to(std::back_inserter(text), "{:.6f},{:.6f},{:.6f}", on_grid.x(), on_grid.y(),
                 on_grid.z());
}

std::string answer_csv(const std::vector<Answer>& answers, bool rigid) {
  std::string text = fmt::format("{}{}\n", fmt::join(kForces, ","),
                                 rigid ? fmt::format(",{}", fmt::join(kTorques, ",")) : "");
  for (const Answer& answer : answers) {
    add_on_grid(text, answer.force);
    if (rigid) {
      text += ",";
      add_on_grid(text, answer.torque);
    }
    text += "\n";
  }
  return text;
}

std::vector<Vector3d> vectors_of(const analysis::CsvTable& table,
                                 const std::array<const char*, 3>& names) {
  const std::vector<double> x = table.numbers(table.column(names[0]));
  const std::vector<double> y = table.numbers(table.column(names[1]));
  const std::vector<double> z = table.numbers(table.column(names[2]));
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < x.size(); ++i) {
    points.emplace_back(x[i], y[i], z[i]);
  }
  return points;
}

std::vector<Answer> answers_of(const analysis::CsvTable& table, bool rigid) {
  std::vector<Answer> answers;
  for (const Vector3d& force : vectors_of(table, kForces)) {
    answers.push_back({force, Vector3d::Zero()});
  }
  if (rigid) {
    const std::vector<Vector3d> torque = vectors_of(table, kTorques);
    for (std::size_t i = 0; i < answers.size(); ++i) {
      answers[i].torque = torque[i];
    }
  }
  return answers;
}

std::vector<Isometry3d> poses_of(const analysis::CsvTable& table, bool rigid) {
  std::vector<Isometry3d> poses;
  for (const Vector3d& place : vectors_of(table, kPlaces)) {
    poses.emplace_back(Eigen::Translation3d(place));
  }
  if (rigid) {
    const std::vector<double> w = table.numbers(table.column(kTurns[0]));
    const std::vector<Vector3d> turn = vectors_of(table, {kTurns[1], kTurns[2], kTurns[3]});
    for (std::size_t i = 0; i < poses.size(); ++i) {
      poses[i].linear() = Eigen::Quaterniond(w[i], turn[i].x(), turn[i].y(), turn[i].z())
                              .normalized()
                              .toRotationMatrix();
    }
  }
  return poses;
}

ExamCase read_case(const fs::path& folder, const nlohmann::json& said) {
  ExamCase one;
  one.name = said.at("name");
  one.task = {folder / std::string(said.at("body")), said.at("stiffness_N_per_m"),
              said.at("friction"), said.at("rate_Hz")};
  if (said.contains("tool")) {
    one.task.tool = folder / std::string(said.at("tool"));
    one.task.turning_stiffness = said.at("turning_stiffness_Nm_per_rad");
  }
  const auto table = analysis::CsvTable::load(folder / std::string(said.at("path")));
  one.tool = poses_of(table, one.task.is_rigid());
  one.truth = answers_of(table, one.task.is_rigid());
  return one;
}

/// Writes the path of a case. @returns what exam.json says about it
Json write_case(const ExamCase& one, exchange::NewFolder& out) {
  const std::string path = "cases/" + one.name + ".csv";
  out.write(path, case_csv(one));
  Json said{{"name", one.name},
            {"body", one.task.body.string()},
            {"path", path},
            {"stiffness_N_per_m", one.task.stiffness},
            {"friction", one.task.friction},
            {"rate_Hz", one.task.rate}};
  if (one.task.is_rigid()) {
    said["tool"] = one.task.tool.string();
    said["turning_stiffness_Nm_per_rad"] = one.task.turning_stiffness;
  }
  return said;
}

void write_mesh(const std::string& file, const geometry::Mesh& mesh, exchange::NewFolder& out) {
  out.write(file, geometry::encode_mesh(mesh, geometry::MeshFormat::kObj));
}

void publish(const char* what, const Json& cases, const char* about, exchange::NewFolder& out) {
  out.write("exam.json", Json{{"exam", what}, {"version", 1}, {"cases", cases}}.dump(2) + "\n");
  out.write("README.md", about);
  out.write("LICENCE", "SPDX-License-Identifier: MIT\nCopyright (c) 2026 the haptrial authors\n");
  out.publish();
}

}  // namespace

void write_exam(const fs::path& folder) {
  exchange::NewFolder out(folder);
  Json cases = Json::array();
  for (const ExamBody& body : exam_bodies()) {
    ExamCase one;
    one.task.body = "bodies/" + words_in_a_row(body.name) + ".obj";
    write_mesh(one.task.body, mesh_of(body.body, kFine), out);
    const std::vector<Vector3d> places = there_and_back(body);
    for (const Vector3d& place : places) {
      one.tool.emplace_back(Eigen::Translation3d(place));
    }
    for (const double friction : {0.0, kFriction}) {
      one.name = words_in_a_row(body.name) + (friction > 0.0 ? "-friction" : "");
      one.task.friction = friction;
      one.truth.clear();
      for (const TrueContact& c : true_contacts(body.body, places, one.task.stiffness, friction)) {
        one.truth.push_back({c.force, Vector3d::Zero()});
      }
      cases.push_back(write_case(one, out));
    }
  }
  publish("contact of a point", cases, kAboutPoints, out);
}

void write_rigid_exam(const fs::path& folder) {
  exchange::NewFolder out(folder);
  Json cases = Json::array();
  const HandSprings springs;
  for (const ExamTool& tool : exam_tools()) {
    const std::string name = words_in_a_row(tool.name);
    ExamCase one{name,
                 {.body = "bodies/" + name + ".obj",
                  .stiffness = springs.stiffness,
                  .tool = "tools/" + name + ".obj",
                  .turning_stiffness = springs.turning_stiffness},
                 there_and_back(tool),
                 {}};
    write_mesh(one.task.body, tool.body, out);
    write_mesh(one.task.tool, tool.tool, out);
    for (const TrueRest& rest : true_rests(tool.tool.vertices, tool.free, one.tool, springs)) {
      one.truth.push_back({rest.force, rest.torque});
    }
    cases.push_back(write_case(one, out));
  }
  publish("contact of a rigid tool", cases, kAboutTools, out);
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
  if (exam.empty()) {
    throw InputError(
        fmt::format("{}: no cases; allowed: what haptrial exam make writes", file.string()));
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
      answer.answer.push_back(candidate.tick(static_cast<double>(i) / one.task.rate, one.tool[i]));
      ticks.push_back(seconds_since(tick));
    }
    const TickTimes times = tick_times(ticks);
    answer.median_tick = times.median;
    answer.worst_tick = times.worst;
    answers.cases.push_back(std::move(answer));
  }
  return answers;
}

void write_answers(const ExamAnswers& answers, const std::optional<FailureMap>& ridges,
                   const std::vector<ExamCase>& exam, const fs::path& folder) {
  exchange::NewFolder out(folder);
  Json costs = Json::object();
  for (std::size_t i = 0; i < exam.size(); ++i) {
    const ExamAnswers::Case& answer = answers.cases[i];
    out.write(exam[i].name + ".csv", answer_csv(answer.answer, exam[i].task.is_rigid()));
    costs[exam[i].name] = {{"preparation_s", answer.preparation},
                           {"median_tick_s", answer.median_tick},
                           {"worst_tick_s", answer.worst_tick}};
  }
  if (ridges) {
    out.write("failures.csv", failure_csv({*ridges}));
  }
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
      answer.answer = answers_of(analysis::CsvTable::load(path), one.task.is_rigid());
      if (answer.answer.size() != one.tool.size()) {
        throw InputError(fmt::format("{}: {} forces; allowed: {}, one for each row of the path",
                                     path.string(), answer.answer.size(), one.tool.size()));
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
