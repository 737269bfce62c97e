// `haptrial run --device mouse --window`: a hand at the mouse follows the path and presses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/render/flat/trial_display.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"
#include "protocols/force_training/force_definition.h"
#include "tests/core/render/flat/pixels.h"
#include "tests/experiments/command.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"
#include "tests/support/wait.h"

namespace haptrial::experiments::live_mouse_test {
namespace {

using test::CommandResult;
using test::ConsolePerson;
using test::LiveCommand;
using testing::HasSubstr;

class LiveMouseTest : public testing::Test {
 protected:
  static constexpr int kWidth = 800;
  static constexpr int kHeight = 600;

  void SetUp() override {
    display_.emplace(kWidth, kHeight);
    test::write_text(folder_ / "study.toml",
                     test::brisk_text({{"conditions", "conditions = [\"visual\"]"},
                                       {"speed", "speed = 0.006"},
                                       {"wait_timeout", "wait_timeout = 600.0"}}));
    definition_ = protocols::load_force_definition(folder_ / "study.toml");
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// The path of the block under way, from the file that is being written.
  std::vector<record::StimulusRow> stimulus() const {
    std::vector<record::StimulusRow> rows;
    test::wait_until([&] {
      try {
        rows = record::SessionReader(folder_ / "out/S01.h5.partial").stimuli();
      } catch (const std::exception&) {  // not there yet
      }
      return !rows.empty();
    });
    return rows;
  }

  /// A press of p, of which the plane (k_plane) takes what the hand's own spring (400 N/m) leaves.
  double force_of_a_press() const {
    const double press = 2.0;
    const double plane = definition_->guidance.plane.stiffness;
    return press * plane / (plane + 400.0);
  }

  /// A hand that knows where on the monitor a point of the path is.
  class Hand {
   public:
    Hand(const test::VirtualDisplay& display, render::TrialDisplayStyle style,
         const std::vector<record::StimulusRow>& path)
        : display_(display) {
      style.width = kWidth;
      style.height = kHeight;
      std::vector<Eigen::Vector3d> points;
      for (const record::StimulusRow& row : path) {
        points.push_back(row.position);
      }
      const auto marker_at = [&](const Eigen::Vector3d& tool) {
        stimulus::Presentation scene;
        scene.show_trajectory = true;
        scene.tool = tool;
        return render::find(render::render_presentation(style, points, scene), style.marker_colour)
            .centre;
      };
      first_ = points.front();
      pixel_ = marker_at(first_);
      scale_ = (marker_at(points.back()) - pixel_).x() / (points.back() - first_).x();
    }
    void move_to(const Eigen::Vector3d& point) const {
      const Eigen::Vector3d way = scale_ * (point - first_);
      display_.move_pointer(static_cast<int>(std::lround(pixel_.x() + way.x())),
                            static_cast<int>(std::lround(pixel_.y() + way.z())));
    }

   private:
    const test::VirtualDisplay& display_;
    Eigen::Vector3d first_;
    Eigen::Vector2d pixel_;
    double scale_{0.0};  // [px/m]
  };

  test::TemporaryFolder folder_;
  std::optional<test::VirtualDisplay> display_;
  std::optional<protocols::ForceDefinition> definition_;
};

TEST_F(LiveMouseTest, ThePointerLeadsTheToolAndAPressIsAForce) {
  const std::string title = definition_->screen.title;
  LiveCommand session("run '" + path("study.toml") + "' --subject S01 --out '" + path("out") +
                      "' --device mouse --window --console");
  ConsolePerson person(session.line_after("console: "));
  ASSERT_TRUE(person.sees("instructions")) << session.errors();
  ASSERT_TRUE(person.ask("start"));
  const std::vector<record::StimulusRow> path_rows = stimulus();
  ASSERT_FALSE(path_rows.empty());
  const Hand hand(*display_, definition_->display, path_rows);
  const auto rests_at_start = [&, i = 0]() mutable {
    const double tremor = i++ % 2 == 0 ? 0.0 : 2e-4;  // no hand is still [m]
    hand.move_to(path_rows.front().position + Eigen::Vector3d(tremor, 0.0, 0.0));
    const nlohmann::json now = person.status();
    return now["state"] == "running" && now["stage"] == "run";
  };
  test::wait_until(rests_at_start);  // so that the run begins

  // The first third without a press, the rest with the left button held. The session says where
  // it is, so that a hand that was held up goes on at the right place.
  const double begin = person.status()["ticks"].get<double>();
  bool pressed = false;
  for (nlohmann::json now = person.status(); now["stage"] == "run"; now = person.status()) {
    const double t = 1e-3 * (now["ticks"].get<double>() - begin);
    const auto row = std::lower_bound(path_rows.begin(), path_rows.end() - 1, t,
                                      [](const auto& r, double time) { return r.time < time; });
    hand.move_to(row->position);
    if (!pressed && t > 0.3 * path_rows.back().time) {
      display_->press_button(title, 1);
      pressed = true;
    }
  }
  display_->release_button(title, 1);
  ASSERT_TRUE(person.ask("end"));
  const CommandResult ended = session.wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;

  const record::SessionReader reader(folder_ / "out/S01.h5");
  EXPECT_EQ(reader.info().device, "mouse");
  EXPECT_FALSE(reader.info().simulated) << "a person moved it";
  EXPECT_TRUE(record::check_session(reader).ok);
  const record::PassRow pass = reader.passes().at(0);
  std::vector<record::Sample> run;
  for (const record::Sample& sample :
       reader.samples(pass.first_sample, pass.last_sample - pass.first_sample + 1)) {
    if (sample.stage == record::Stage::kRun) {
      run.push_back(sample);
    }
  }
  ASSERT_GT(run.size(), 1000u);
  const Eigen::Vector3d& first = path_rows.front().position;
  EXPECT_NEAR((run.front().position - first).norm(), 0.0, 0.004);
  const double length = path_rows.back().position.x() - first.x();
  EXPECT_GT(run.back().position.x() - first.x(), 0.8 * length);

  const double expected = force_of_a_press();
  const auto felt = std::ranges::find_if(
      run, [&](const record::Sample& sample) { return sample.applied_force > 0.5 * expected; });
  ASSERT_GT(felt - run.begin(), 500);
  ASSERT_GT(run.end() - felt, 1000);
  // The means over some time: single readings carry the noise of a quantised velocity.
  const auto mean_force = [](auto from, auto to) {
    const auto add = [](double sum, const auto& sample) { return sum + sample.applied_force; };
    return std::accumulate(from, to, 0.0, add) / static_cast<double>(to - from);
  };
  EXPECT_NEAR(mean_force(run.begin() + 200, felt - 200), 0.0, 0.03);
  EXPECT_NEAR(mean_force(felt + 500, run.end() - 200), expected, 0.1);
}

TEST_F(LiveMouseTest, WithoutItsWindowItIsASentenceAndNothingIsLeft) {
  const CommandResult result =
      test::run_command("haptrial run '" + path("study.toml") +
                        "' --subject S01 --trials 1 --device mouse --out '" + path("out") + "'");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("--window"));
  EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

}  // namespace

// Every shipped definition at a mouse and a window: it begins, the person ends it by Escape or the
// window's close button, it is resumed, the experimenter ends it, and its file is whole.

namespace {

namespace fs = std::filesystem;
using test::VirtualDisplay;

fs::path definition_of(const std::string& name) {
  return fs::path(HAPTRIAL_SOURCE_DIR "/experiments") / (name + ".toml");
}

/// Those in the folder of shipped definitions, without files of texts.
std::vector<std::string> shipped_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(HAPTRIAL_SOURCE_DIR "/experiments")) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() == ".toml" && name.find('.') == std::string::npos) {
      names.push_back(name);
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

class MouseSessionTest : public testing::TestWithParam<std::string> {
 protected:
  std::string run(const std::string& more) const {
    const auto d = load_experiment(definition_of(GetParam())).definition;
    const char* second = protocols::tips_of(d->arms()) > 1 ? " --device virtual" : "";
    return "run '" + definition_of(GetParam()).string() + "' --device mouse" + second +
           " --window --out '" + folder_.path().string() + "' --subject S01 " + more;
  }
  fs::path partial() const { return folder_ / "S01.h5.partial"; }
  bool has_begun() const {
    try {
      return !record::SessionReader(partial()).begun().empty();
    } catch (const std::exception&) {  // not there yet, or being written
      return false;
    }
  }
  /// Leaves texts and pages until a pass has begun, then the session.
  void sit_at_the_mouse(const std::string& title, bool closes) const {
    test::LiveCommand session(run(""));
    ASSERT_TRUE(session.reaches([&] {
      display_.try_key(title, ' ');
      display_.try_key(title, VirtualDisplay::kEnter);
      return has_begun();
    })) << session.errors();
    if (closes) {
      display_.ask_to_close(title);
    } else {
      display_.press_key(title, VirtualDisplay::kEscape);
    }
    EXPECT_EQ(session.wait().status, 1) << session.errors();
  }
  static void expect_whole(const fs::path& file) {
    const record::SessionReader reader(file);
    const record::Integrity report = record::check_session(reader, known_tables());
    EXPECT_TRUE(report.ok) << testing::PrintToString(report.problems);
  }

  test::TemporaryFolder folder_;
  VirtualDisplay display_{800, 600};
};

TEST_P(MouseSessionTest, IsEndedByAPersonAndResumedAndEndedByTheExperimenter) {
  const std::vector<std::string> names = shipped_names();
  const auto place = std::find(names.begin(), names.end(), GetParam()) - names.begin();
  const std::string title = load_experiment(definition_of(GetParam())).definition->screen.title;
  ASSERT_NO_FATAL_FAILURE(sit_at_the_mouse(title, place % 2 == 1));
  expect_whole(partial());
  const test::CommandResult alone =
      test::run_command("haptrial run '" + definition_of(GetParam()).string() + "' --out '" +
                        folder_.path().string() + "' --subject S01 --resume");
  EXPECT_EQ(alone.status, 2) << "a virtual participant would finish a person's session";
  EXPECT_THAT(alone.errors, testing::HasSubstr("was recorded with a person, on the device mouse; "
                                               "resume it with --device mouse, not virtual"));
  test::LiveCommand session(run("--resume --console"));
  test::ConsolePerson experimenter(session.line_after("console: "));
  ASSERT_TRUE(experimenter.sees("instructions")) << session.errors();
  ASSERT_TRUE(experimenter.ask("end")) << session.errors();
  EXPECT_EQ(session.wait().status, 0) << session.errors();
  ASSERT_TRUE(fs::exists(folder_ / "S01.h5"));
  expect_whole(folder_ / "S01.h5");
}

INSTANTIATE_TEST_SUITE_P(Shipped, MouseSessionTest, testing::ValuesIn(shipped_names()),
                         [](const auto& tested) { return tested.param; });

}  // namespace
}  // namespace haptrial::experiments::live_mouse_test
