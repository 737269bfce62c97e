#include "analysis/contact/exam/exam.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>

#include "analysis/contact/exam/answer_tables.h"
#include "analysis/contact/exam/exam_bodies.h"
#include "analysis/contact/exam/exam_soft.h"
#include "analysis/contact/exam/exam_tools.h"
#include "analysis/contact/truth/true_contact.h"
#include "analysis/files/csv.h"
#include "analysis/files/new_folder.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/parallel.h"
#include "core/geometry/files/mesh_io.h"

namespace haptrial::evaluation {
namespace {

namespace fs = std::filesystem;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using Json = nlohmann::ordered_json;

constexpr int kFine = 4;  // edges of curved bodies: 0.5 to 0.8 mm
constexpr double kFriction = 0.3;

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

constexpr const char* kAboutSofts = R"(# An exam for soft bodies

Bodies of tetrahedra give way to a tool that holds some of their vertices, or to forces. They are led
there and back so slowly that the truth is the body at rest, by neo-Hookean elements on finer meshes.
The last one is free: forces push it for 0.1 s, then it must keep its momentum.

- exam.json names the cases: body, path, rate (Hz), and the samples at which the shape is asked.
- bodies/NAME.node and .ele are in TetGen's form, in metres: a vertex has its place, the force on it
  (N) and a marker (1 fixed, 2 held by the tool); a tetrahedron has its corners, Young's modulus (Pa),
  Poisson's ratio and density (kg/m3).
- cases/CASE.csv has how far the tool has moved the vertices that it holds (x_m, y_m, z_m), the share
  of the forces that acts (load), and the true force on the tool (force_x_N, ...).
- shapes/CASE.csv has the true displacements (sample, vertex, ux_m, uy_m, uz_m).

Answers are a folder with CASE.csv (force_x_N, force_y_N, force_z_N, a row for each row of the path)
and CASE-shape.csv (as in shapes) for each case. `haptrial exam run` writes one for a model of
haptrial, or for any program that answers on a pipe; `haptrial exam score` compares answers with the
truth.
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

std::string case_csv(const ExamCase& one) {
  const bool rigid = one.task.is_rigid();
  std::string text = fmt::format("time_s,{}{}{},{}{}\n", fmt::join(kPlaces, ","),
                                 rigid ? fmt::format(",{}", fmt::join(kTurns, ",")) : "",
                                 one.task.is_soft() ? ",load" : "", fmt::join(kForces, ","),
                                 rigid ? fmt::format(",{}", fmt::join(kTorques, ",")) : "");
  for (std::size_t i = 0; i < one.tool.size(); ++i) {
    const Vector3d &f = one.truth[i].force, &m = one.truth[i].torque;
    fmt::format_to(std::back_inserter(text), "{},{}{},{},{},{}",
                   static_cast<double>(i) / one.task.rate, pose_words(one.tool[i], rigid),
                   one.task.is_soft() ? fmt::format(",{}", one.load[i]) : "", f.x(), f.y(), f.z());
    text += rigid ? fmt::format(",{},{},{}\n", m.x(), m.y(), m.z()) : "\n";
  }
  return text;
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

/// Samples from one on, at equal distances.
std::vector<std::size_t> samples_of(const nlohmann::json& said, std::size_t samples) {
  const std::size_t first = said.at("first_sample"), every = said.at("every");
  if (every == 0 || first >= samples) {
    throw InputError(fmt::format(
        "exam.json: shapes from sample {} on, every {}; allowed: within the {} of the path", first,
        every, samples));
  }
  std::vector<std::size_t> found;
  for (std::size_t i = first; i < samples; i += every) {
    found.push_back(i);
  }
  return found;
}

void read_soft_case(const fs::path& folder, const nlohmann::json& said,
                    const analysis::CsvTable& table, ExamCase& one) {
  one.load = table.numbers(table.column("load"));
  one.shape_samples = samples_of(said.at("shapes"), one.tool.size());
  if (said.at("shapes").contains("truth")) {
    read_shapes(folder / std::string(said.at("shapes").at("truth")), one.shape_samples,
                read_soft_body(one.task.body).mesh.vertices.size(), one.truth);
  }
}

ExamCase read_case(const fs::path& folder, const nlohmann::json& said) {
  ExamCase one;
  one.name = said.at("name");
  one.task.body = folder / std::string(said.at("body"));
  one.task.rate = said.at("rate_Hz");
  if (!one.task.is_soft()) {
    one.task.stiffness = said.at("stiffness_N_per_m");
    one.task.friction = said.at("friction");
  }
  if (said.contains("tool")) {
    one.task.tool = folder / std::string(said.at("tool"));
    one.task.turning_stiffness = said.at("turning_stiffness_Nm_per_rad");
  }
  const auto table = analysis::CsvTable::load(folder / std::string(said.at("path")));
  one.tool = poses_of(table, one.task.is_rigid());
  one.truth = answers_of(table, one.task.is_rigid());
  if (one.task.is_soft()) {
    read_soft_case(folder, said, table, one);
  }
  return one;
}

/// Writes the true shapes of a case and says which ones are asked.
void write_soft_case(const ExamCase& one, exchange::NewFolder& out, Json& said) {
  const std::vector<std::size_t>& samples = one.shape_samples;
  said["shapes"] = {{"first_sample", samples.front()}, {"every", samples[1] - samples[0]}};
  if (!one.truth[samples.back()].shape.empty()) {
    const std::string file = "shapes/" + one.name + ".csv";
    out.write(file, shape_csv(samples, one.truth));
    said["shapes"]["truth"] = file;
  }
}

/// Writes the path of a case. @returns what exam.json says about it
Json write_case(const ExamCase& one, exchange::NewFolder& out) {
  const std::string path = "cases/" + one.name + ".csv";
  out.write(path, case_csv(one));
  Json said{{"name", one.name},
            {"body", one.task.body.string()},
            {"path", path},
            {"rate_Hz", one.task.rate}};
  if (one.task.is_soft()) {
    write_soft_case(one, out, said);
    return said;
  }
  said["stiffness_N_per_m"] = one.task.stiffness;
  said["friction"] = one.task.friction;
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

namespace {

constexpr int kSoftTicks = 2000;  // there and back at 1 kHz

/// A body that is led there and back, slowly enough for what rests to be the truth.
ExamCase led_case(const ExamSoft& soft) {
  constexpr std::size_t kEvery = 50;
  ExamCase one;
  std::vector<double> ways;
  for (int i = 0; i <= kSoftTicks; ++i) {
    ways.push_back(0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * i / kSoftTicks)));
    one.tool.emplace_back(
        Eigen::Translation3d(soft.tool(ways.back()) + Vector3d::Zero()));  // no "-0"
    one.load.push_back(soft.load(ways.back()));
  }
  std::vector<SoftRest> rests = true_softs(soft, ways);
  for (std::size_t i = 0; i < rests.size(); ++i) {
    one.truth.push_back({rests[i].force, Vector3d::Zero()});
    if (i % kEvery == 0) {
      one.shape_samples.push_back(i);
      one.truth.back().shape = std::move(rests[i].shape);
    }
  }
  return one;
}

/// A body that forces push until it flies; its shape is asked from then on.
ExamCase free_case() {
  constexpr std::size_t kTicks = 300;
  ExamCase one;
  for (std::size_t i = 0; i <= kTicks; ++i) {
    one.tool.push_back(Isometry3d::Identity());
    one.load.push_back(free_load(static_cast<double>(i) / one.task.rate));
    one.truth.emplace_back();
    if (i > 0 && one.load[i - 1] == 0.0 && one.load[i] == 0.0) {
      one.shape_samples.push_back(i);
    }
  }
  return one;
}

Json write_soft(ExamCase one, const std::string& name, const SoftBody& body,
                exchange::NewFolder& out) {
  one.name = words_in_a_row(name);
  const std::string file = "bodies/" + one.name;
  out.write(file + ".node", node_text(body));
  out.write(file + ".ele", element_text(body));
  one.task.body = file + ".node";
  return write_case(one, out);
}

}  // namespace

void write_soft_exam(const fs::path& folder) {
  exchange::NewFolder out(folder);
  const std::vector<ExamSoft>& softs = exam_softs();
  std::vector<ExamCase> led(softs.size());
  parallel_for(softs.size(), 0, [&](std::size_t i) { led[i] = led_case(softs[i]); });
  Json cases = Json::array();
  for (std::size_t i = 0; i < softs.size(); ++i) {
    cases.push_back(write_soft(std::move(led[i]), softs[i].name, softs[i].body(1), out));
  }
  cases.push_back(write_soft(free_case(), "free block", free_block(), out));
  publish("soft bodies", cases, kAboutSofts, out);
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

}  // namespace haptrial::evaluation
