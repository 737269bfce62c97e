#include "analysis/contact/evaluation/evaluation_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "analysis/contact/demo_study/simulated_probe.h"
#include "analysis/files/csv.h"
#include "core/base/definition/table.h"

namespace haptrial::evaluation {
namespace {

using testing::HasSubstr;

const Evaluation& rubbed_duck() {
  static const Evaluation evaluation = [] {
    const contact::FeltBody body(radial_mesh(duck_radius, 30));
    SimulatedProbe probe;
    probe.seconds = 10.0;
    probe.force_rate = 500.0;
    EvaluationOptions options;
    options.prepare.registered = true;
    options.prepare.lag = 0.0;
    options.prepare.load = probe.load;
    options.renderers = {contact::RendererKind::kProxy, contact::RendererKind::kVoxel};
    return evaluate_rendering(simulate_probe(duck_radius, probe), body, options);
  }();
  return evaluation;
}

TEST(EvaluationReportTest, SaysThatItIsSimulated) {
  const EvaluationNames names{"probe", "duck", true};
  const analysis::Document report = evaluation_report(rubbed_duck(), names, {});
  EXPECT_TRUE(report.simulated);
  EXPECT_THAT(analysis::to_html(report), HasSubstr("SIMULATED RECORDING"));
  for (const analysis::Figure& figure : evaluation_figures(rubbed_duck(), names)) {
    EXPECT_TRUE(figure.simulated) << figure.name;
  }
  EXPECT_THAT(evaluation_json(rubbed_duck(), names), HasSubstr("\"simulated\": true"));
  EXPECT_THAT(analysis::to_html(evaluation_report(rubbed_duck(), {"probe", "duck", false}, {})),
              testing::Not(HasSubstr("SIMULATED")));
}

/// The picture of the residual shows contacts and not the air: all within the noise of the poses.
TEST(EvaluationReportTest, ResidualsAreThoseOfContacts) {
  const auto figures = evaluation_figures(rubbed_duck(), {});
  const auto residual = std::find_if(figures.begin(), figures.end(),
                                     [](const auto& f) { return f.name == "residual"; });
  ASSERT_NE(residual, figures.end());
  const analysis::Series& bars = residual->series.front();
  EXPECT_GT(bars.x.front(), -1.0) << "[mm]";
  EXPECT_LT(bars.x.back(), 1.0) << "[mm]";
  const double shown = std::accumulate(bars.y2.begin(), bars.y2.end(), 0.0);
  const ContactSamples& s = rubbed_duck().contact.samples;
  double contacts = 0.0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    contacts += s.force[i].dot(s.normal[i]) > rubbed_duck().contact.least_force ? 1.0 : 0.0;
  }
  EXPECT_GT(shown, 0.98 * contacts);
  EXPECT_LE(shown, contacts);
}

TEST(EvaluationReportTest, LinesNameEveryRendering) {
  const auto lines = evaluation_lines(rubbed_duck());
  for (const EvaluatedRendering& r : rubbed_duck().renderings) {
    EXPECT_THAT(lines, testing::Contains(testing::StartsWith(name_of(r) + " ")));
  }
  EXPECT_EQ(rubbed_duck().renderings.size(), 3u);
  EXPECT_THAT(name_of(rubbed_duck().renderings.back()), testing::StartsWith("proxy with friction"));
}

/// Counts of renderers stand in the lines, the report and the file, by the same names.
TEST(EvaluationReportTest, OperationsAreToldByTheirNames) {
  const std::string page = analysis::to_html(evaluation_report(rubbed_duck(), {}, {}));
  const std::string file = evaluation_json(rubbed_duck(), {});
  for (const EvaluatedRendering& r : rubbed_duck().renderings) {
    const contact::Operations& done = r.rendered.operations;
    EXPECT_EQ(done.ticks, rubbed_duck().contact.in.size());
    for (const contact::OperationCount& c : contact::kOperationCounts) {
      EXPECT_LE(done.*c.count, done.ticks * (r.rendered.most.*c.count)) << c.name;
      if (done.*c.count > 0) {
        EXPECT_THAT(page, HasSubstr(std::string(c.name)));
        EXPECT_THAT(evaluation_lines(rubbed_duck()),
                    testing::Contains(HasSubstr(std::string(c.name))));
      }
      EXPECT_THAT(file, HasSubstr("\"" + std::string(c.name) + "\""));
    }
    if (r.kind == contact::RendererKind::kVoxel) {
      EXPECT_EQ(r.rendered.most,
                (contact::Operations{.ticks = 1, .triangles_tested = 1, .cells = 1}));
    } else {
      EXPECT_GT(done.sweeps, done.ticks / 10);
    }
  }
}

/// Each row of the table keeps the law of the in-trajectory (§7.3.1), and has what was rendered.
TEST(EvaluationFilesTest, TheContactIsThereTickByTick) {
  const PreparedContact& c = rubbed_duck().contact;
  const auto table = analysis::CsvTable::parse(contact_csv(rubbed_duck()), "contact.csv");
  ASSERT_EQ(table.rows(), c.time.size());
  const auto vectors = [&](const std::string& what, const std::string& unit) {
    std::array<std::vector<double>, 3> columns;
    for (std::size_t i = 0; i < 3; ++i) {
      columns[i] = table.numbers(table.column(what + "_" + "xyz"[i] + "_" + unit));
    }
    return columns;
  };
  const auto out = vectors("out", "m");
  const auto in = vectors("in", "m");
  const auto force = vectors("force", "N");
  const auto rendered = vectors("proxy", "N");
  const auto touching = table.numbers(table.column("touching"));
  for (std::size_t row = 0; row < table.rows(); ++row) {
    Eigen::Vector3d depth, f, r;
    for (int i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      depth[i] = out[axis][row] - in[axis][row];
      f[i] = force[axis][row];
      r[i] = rendered[axis][row];
    }
    const double pressed = std::max(0.0, f.dot(c.normal[row]));
    EXPECT_NEAR(depth.norm(), pressed / c.stiffness, 1e-8) << row;
    EXPECT_EQ(touching[row] == 1.0, pressed > c.least_force) << row;
    EXPECT_LT((r - rubbed_duck().renderings[0].rendered.force[row]).norm(), 1e-7) << row;
  }
}

/// A definition of trials can hold what was identified: the duck is hard and has a friction of 0.2.
TEST(EvaluationFilesTest, TheObjectIsATableOfADefinition) {
  const EvaluationNames names{"probe.csv", "duck.stl", true, 1e-3};
  const std::string text = objects_toml(rubbed_duck(), names);
  EXPECT_THAT(text, testing::StartsWith("# SIMULATED: probe.csv on duck.stl"));
  Table root = Table::parse(text, "objects.toml");
  Table object = root.table("objects").table("recorded");
  EXPECT_EQ(object.text("mesh"), "duck.stl");
  EXPECT_EQ(object.number("scale", {}, ""), 1e-3);
  EXPECT_EQ(object.number("damping", {}, ""), 0.0) << "an object without it is refused";
  Table friction = object.table("friction");
  EXPECT_NEAR(friction.number("dynamic", {}, ""), 0.2, 0.02);
  EXPECT_TRUE(friction.has("static"));
  const Interval& k = rubbed_duck().identified->stiffness;
  EXPECT_EQ(object.has("stiffness"), std::isfinite(k.value)) << text;
}

TEST(EvaluationFilesTest, WhatIsNotKnownIsNotStated) {
  Evaluation unknown = rubbed_duck();
  unknown.identified->dynamic_friction.reset();
  unknown.identified->static_friction.reset();
  EXPECT_THAT(objects_toml(unknown, {"a", "b"}),
              testing::AllOf(HasSubstr("# friction: not known from the recording"),
                             testing::Not(HasSubstr("friction]"))));
  unknown.identified->dynamic_friction = Interval{0.3, 0.25, 0.35};
  EXPECT_THAT(objects_toml(unknown, {"a", "b"}),
              HasSubstr("static = 0.3  # the other one's; this one is not known"));
  unknown.identified->static_friction = Interval{0.2958, 0.29, 0.3016};
  unknown.identified->dynamic_friction = Interval{0.3002, 0.295, 0.3054};
  EXPECT_THAT(objects_toml(unknown, {"a", "b"}),
              HasSubstr("static = 0.3002  # found as 0.2958 (95 %: 0.29 to 0.3016); a definition "
                        "allows no less than 0.3002\ndynamic = 0.3002  # 95 %: 0.295 to 0.3054"));
  unknown.identified.reset();
  EXPECT_THAT(objects_toml(unknown, {"a", "b"}), HasSubstr("tells neither stiffness nor friction"));
}

}  // namespace
}  // namespace haptrial::evaluation
