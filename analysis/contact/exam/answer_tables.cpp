#include "analysis/contact/exam/answer_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iterator>

#include "core/base/error.h"

namespace haptrial::evaluation {
namespace {

using Eigen::Vector3d;

constexpr double kGrain = 1e-6;       // of forces [N]
constexpr double kShapeGrain = 1e-9;  // [m]
constexpr std::array kMoved{"ux_m", "uy_m", "uz_m"};

Eigen::Array3d on_grid(const Vector3d& v, double grain) {
  return (v.array() / grain).round() * grain + 0.0;  // no "-0"
}

void add_on_grid(std::string& text, const Vector3d& v) {
  const Eigen::Array3d near = on_grid(v, kGrain);
  fmt::format_to(std::back_inserter(text), "{:.6f},{:.6f},{:.6f}", near.x(), near.y(), near.z());
}

}  // namespace

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

std::string shape_csv(const std::vector<std::size_t>& samples, const std::vector<Answer>& answers) {
  std::string text = fmt::format("sample,vertex,{}\n", fmt::join(kMoved, ","));
  for (const std::size_t i : samples) {
    for (std::size_t v = 0; v < answers[i].shape.size(); ++v) {
      const Eigen::Array3d u = on_grid(answers[i].shape[v], kShapeGrain);
      fmt::format_to(std::back_inserter(text), "{},{},{:.9f},{:.9f},{:.9f}\n", i, v, u.x(), u.y(),
                     u.z());
    }
  }
  return text;
}

void read_shapes(const std::filesystem::path& file, const std::vector<std::size_t>& samples,
                 std::size_t vertices, std::vector<Answer>& answers) {
  const auto table = analysis::CsvTable::load(file);
  const std::size_t rows = samples.size() * vertices;
  if (table.rows() != rows) {
    throw InputError(
        fmt::format("{}: {} rows; allowed: {}, one for each of {} samples and {} "
                    "vertices",
                    file.string(), table.rows(), rows, samples.size(), vertices));
  }
  const std::size_t sample = table.column("sample"), vertex = table.column("vertex");
  const std::vector<double> said = table.numbers(sample), numbers = table.numbers(vertex);
  const std::vector<Vector3d> moved = vectors_of(table, kMoved);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t i = samples[row / vertices], v = row % vertices;
    if (said[row] != static_cast<double>(i)) {
      table.refuse(row, sample, fmt::format("{}", i));
    }
    if (numbers[row] != static_cast<double>(v)) {
      table.refuse(row, vertex, fmt::format("{}", v));
    }
    answers[i].shape.push_back(moved[row]);
  }
}

}  // namespace haptrial::evaluation
