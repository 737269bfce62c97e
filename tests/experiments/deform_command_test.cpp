// haptrial deform, as it is called from a shell.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kBar = R"([body]
block = [0.02, 0.02, 0.04]
resolution = 4

[material]
young = 10e3
poisson = 0.0

[elements]
law = "linear"

[regions]
bottom.side = "-z"
top.side = "+z"
corner.nearest = [0.02, 0.02, 0.04]

[loads.pull]
held = ["bottom"]
pressures = [{ region = "top", pressure = -100.0 }]

[loads.bend]
held = ["bottom"]
forces = [{ region = "top", force = [0.004, 0.0, 0.0] }]
unseen = true
)";

class DeformCommandTest : public testing::Test {
 protected:
  DeformCommandTest() { test::write_text(folder_ / "bar.toml", kBar); }
  test::CommandResult run(const std::string& line) {
    return test::run_command("cd '" + folder_.path().string() + "'\n" + line);
  }
  nlohmann::json json(const std::string& file) {
    return nlohmann::json::parse(test::read_text(folder_ / file));
  }
  /// The bar with one line of it replaced.
  void write_bar_with(const std::string& line, const std::string& by) {
    std::string text = kBar;
    const auto at = text.find(line);
    ASSERT_NE(at, std::string::npos) << line;
    test::write_text(folder_ / "bar.toml", text.replace(at, line.size(), by));
  }
  test::TemporaryFolder folder_;
};

TEST_F(DeformCommandTest, InfoSaysWhatABodyIs) {
  const auto info = run("haptrial deform info bar.toml --springs 0.01 0.01 0.01");
  ASSERT_EQ(info.status, 0) << info.errors;
  EXPECT_THAT(info.output, HasSubstr("80 tetrahedra, 45 vertices"));
  EXPECT_THAT(info.output, HasSubstr("inverted    0, flat 0"));
  EXPECT_THAT(info.output, HasSubstr("volume      1.6e-05 m3"));
  EXPECT_THAT(info.output, HasSubstr("mass        0.016 kg"));
  EXPECT_THAT(info.output, HasSubstr("s at most for springs of 0.01, 0.01 and 0.01 J"));
}

// A bar without lateral strain: u = p z / E.
TEST_F(DeformCommandTest, ReferenceIsWhatTheLawSays) {
  const auto reference = run("haptrial deform reference bar.toml --load pull --out ref");
  ASSERT_EQ(reference.status, 0) << reference.errors;
  const double expected = 100.0 / 10e3 * 0.04;
  EXPECT_NEAR(json("ref/reference.json")["loads"][0]["largest_m"].get<double>(), expected,
              1e-6 * expected);
  EXPECT_THAT(test::read_text(folder_ / "ref/pull.vtu"), HasSubstr("von_mises_Pa"));
  EXPECT_FALSE(fs::exists(folder_ / "ref/bend.csv"));
  EXPECT_EQ(run("haptrial deform reference bar.toml --out ref").status, 2) << "the folder is full";
  const auto dynamic =
      run("haptrial deform reference bar.toml --load pull --model dynamic --seconds 2 --step 0.01 "
          "--damping 40 --out later");
  ASSERT_EQ(dynamic.status, 0) << dynamic.errors;
  EXPECT_NEAR(json("later/reference.json")["loads"][0]["largest_m"].get<double>(), expected,
              1e-3 * expected);
}

TEST_F(DeformCommandTest, CalibrateFindsWhatFollowsTheReference) {
  const auto found = run("haptrial deform calibrate bar.toml --evaluations 60 --out cal");
  ASSERT_EQ(found.status, 0) << found.errors;
  const auto numbers = json("cal/calibration.json");
  EXPECT_LT(numbers["error_m"].get<double>(), 0.2 * numbers["loads"][0]["moved_m"].get<double>());
  EXPECT_LT(numbers["error_m"].get<double>(), numbers["hand_error_m"].get<double>());
  EXPECT_LT(numbers["change_by_tighter_rest_m"].get<double>(),
            1e-6 * numbers["loads"][0]["moved_m"].get<double>());
  EXPECT_TRUE(numbers["loads"][1]["unseen"].get<bool>());
  const std::string report = test::read_text(folder_ / "cal/report.html");
  EXPECT_THAT(report, HasSubstr("data:image/png;base64"));
  EXPECT_THAT(report, HasSubstr("unseen"));
  EXPECT_FALSE(fs::exists(folder_ / "cal.evaluations")) << "the journal is not needed any more";
}

/// Made loads are followed and held out by turns; shared out by material the constants hold for a
/// load that they never saw, better than equal ones.
TEST_F(DeformCommandTest, MadeLoadsAndSharesHoldForAnUnseenLoad) {
  const auto left = [&](const std::string& options, const std::string& part) {
    const auto found = run("haptrial deform calibrate bar.toml --evaluations 40 " + options);
    EXPECT_EQ(found.status, 0) << found.errors;
    EXPECT_THAT(found.output, HasSubstr("left of the motion"));
    const std::string folder = options.substr(options.rfind(' ') + 1);
    return json(folder + "/calibration.json")[part + "_share_left"].get<double>();
  };
  const double made = left("--made 4 --out made", "unseen");
  EXPECT_LT(made, 1.3 * json("made/calibration.json")["seen_share_left"].get<double>());
  EXPECT_LT(made, left("--share equal --out equal", "unseen"));
  int held_out = 0;
  const auto loads = json("made/calibration.json")["loads"];
  for (const auto& load : loads) {
    held_out += load["held_out"].get<bool>() ? 1 : 0;
  }
  EXPECT_EQ(loads.size(), 6u);
  EXPECT_EQ(held_out, 2);
  EXPECT_EQ(loads[3]["name"], "made 2");
}

/// The motion by CVODE ends where the static solution is, and passes where implicit midpoint steps
/// do; springs are told the damping with which they follow it.
TEST_F(DeformCommandTest, AMotionIsToldToATolerance) {
  ASSERT_EQ(run("haptrial deform calibrate bar.toml --evaluations 30 --out cal").status, 0);
  const auto motion =
      run("haptrial deform reference bar.toml --load pull --motion --seconds 0.2 --frames 10 "
          "--damping 20 --constants cal/constants.csv --out motion");
  ASSERT_EQ(motion.status, 0) << motion.errors;
  EXPECT_THAT(motion.output, HasSubstr("springs come nearest with --damping"));
  ASSERT_EQ(run("haptrial deform reference bar.toml --load pull --model dynamic --seconds 0.2 "
                "--step 2e-4 --damping 20 --out steps")
                .status,
            0);
  const auto exact = json("motion/reference.json")["loads"][0];
  const double largest = exact["largest_m"].get<double>();
  EXPECT_NEAR(json("steps/reference.json")["loads"][0]["largest_m"].get<double>(), largest,
              0.02 * largest);
  EXPECT_LE(exact["springs_distance_m"].get<double>(),
            1.001 * exact["springs_distance_same_damping_m"].get<double>());
  EXPECT_LT(exact["springs_distance_m"].get<double>(), 0.5 * exact["motion_rms_m"].get<double>());
  EXPECT_TRUE(fs::exists(folder_ / "motion/pull-motion.csv"));
  for (const std::string option :
       {"--constants cal/constants.csv", "--frames 5", "--tolerance 1e-6"}) {
    const auto without = run("haptrial deform reference bar.toml --out no " + option);
    EXPECT_EQ(without.status, 2);
    EXPECT_THAT(without.errors,
                HasSubstr(option.substr(0, option.find(' ')) + " requires --motion"));
  }
}

/// Displacements of another program are the reference: those of our own elements give the same.
TEST_F(DeformCommandTest, AReferenceFromAFileIsTaken) {
  ASSERT_EQ(run("haptrial deform reference bar.toml --out ref").status, 0);
  ASSERT_EQ(run("haptrial deform calibrate bar.toml --evaluations 5 --out own").status, 0);
  write_bar_with("held = [\"bottom\"]\npressures",
                 "reference = \"ref/pull.csv\"\nheld = [\"bottom\"]\npressures");
  const auto given = run("haptrial deform calibrate bar.toml --evaluations 5 --out given");
  ASSERT_EQ(given.status, 0) << given.errors;
  EXPECT_NEAR(json("given/calibration.json")["error_m"].get<double>(),
              json("own/calibration.json")["error_m"].get<double>(), 1e-9);
}

TEST_F(DeformCommandTest, AKilledAnnealingGoesOnAsIfNothingHadHappened) {
  const std::string command =
      "haptrial deform calibrate bar.toml --method annealing --samples 30 --evaluations 120 ";
  ASSERT_EQ(run(command + "--out whole").status, 0);
  run("timeout -s KILL 0.7 " + command + "--out cut");
  const auto resumed = run(command + "--out cut");
  ASSERT_EQ(resumed.status, 0) << resumed.errors;
  EXPECT_EQ(test::read_text(folder_ / "cut/evaluations.csv"),
            test::read_text(folder_ / "whole/evaluations.csv"));
  test::write_text(folder_ / "other.evaluations", "calibration 0\n");
  const auto other = run(command + "--out other");
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.errors, HasSubstr("is the journal of another calibration"));
}

TEST_F(DeformCommandTest, SpringsComeToRestAndSkinsFollow) {
  const auto motion =
      run("haptrial deform simulate bar.toml --load pull --springs 0.01 0.01 0.01 --to-rest "
          "--seconds 10 --frames 5 --out motion");
  ASSERT_EQ(motion.status, 0) << motion.errors;
  EXPECT_THAT(motion.output, HasSubstr(", at rest"));
  EXPECT_THAT(test::read_text(folder_ / "motion/series.pvd"), HasSubstr("frame-0001.vtu"));
  const auto elements =
      run("haptrial deform simulate bar.toml --model elements --load pull --seconds 2 --step 0.01 "
          "--damping 40 --frames 2 --out elements");
  ASSERT_EQ(elements.status, 0) << elements.errors;
  EXPECT_THAT(elements.output, HasSubstr("3 frames"));
  ASSERT_EQ(run("haptrial mesh make sphere ball.ply").status, 0);
  const auto skin =
      run("haptrial deform skin bar.toml ball.ply motion/frame-0000.csv motion/frame-0001.csv "
          "--scale 0.2 --format obj --out skin");
  ASSERT_EQ(skin.status, 0) << skin.errors;
  EXPECT_TRUE(fs::exists(folder_ / "skin/frame-0001.obj"));
  const auto rest = run("haptrial mesh info skin/frame-0000.obj");
  const auto ball = run("haptrial mesh info ball.ply");
  EXPECT_EQ(rest.status, 0);
  EXPECT_EQ(ball.status, 0);
}

/// A ball that a virtual participant strokes, 3 cm below the origin.
constexpr const char* kStrokedBall = R"(
[experiment]
protocol = "trials"
name = "round_a_ball"
[design]
participants = 1
[objects.ball]
mesh = "ball.obj"
centre = [0.0, -0.03, 0.0]
stiffness = 600.0
damping = 0.0
fade_in = 0.0
record = true
[[stages]]
name = "explore"
fields = ["ball"]
until = { time = 4.0 }
[[blocks]]
name = "only"
trials = 1
[observer]
[observer.actions]
explore = { do = "follow", turn_after = 2.0 }
[texts]
instructions = "Go round it."
)";

constexpr const char* kSoftBall = R"([body]
mesh = "ball.obj"
shift = [0.0, -0.03, 0.0]
resolution = 6
[material]
young = 30e3
poisson = 0.4
[regions]
core = { low = [-0.009, -0.039, -0.009], high = [0.009, -0.021, 0.009] }
[loads.stroke]
held = ["core"]
session = "study/S01.h5"
touches = 3
)";

TEST_F(DeformCommandTest, TouchesOfASessionAreLoads) {
  test::write_text(folder_ / "ball.toml", kStrokedBall);
  test::write_text(folder_ / "soft.toml", kSoftBall);
  ASSERT_EQ(run("haptrial mesh make sphere body.obj\nhaptrial mesh repair body.obj ball.obj "
                "--scale 0.5")
                .status,
            0);
  const auto rehearsed = run("haptrial dry-run ball.toml --out study");
  ASSERT_EQ(rehearsed.status, 0) << rehearsed.errors;
  const auto result = run("haptrial deform reference soft.toml --out out");
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto numbers = json("out/reference.json");
  ASSERT_EQ(numbers["loads"].size(), 3u);
  EXPECT_EQ(numbers["loads"][2]["name"], "stroke 3");
  for (const auto& load : numbers["loads"]) {
    EXPECT_GT(load["largest_m"].get<double>(), 1e-6);
  }
  EXPECT_THAT(test::read_text(folder_ / "out/report.html"), HasSubstr("SIMULATED"));
  EXPECT_EQ(numbers["simulated"], true);
  EXPECT_THAT(result.output, HasSubstr("SIMULATED"));
  // One touch by its name; and a body that stands elsewhere.
  const auto second =
      run("haptrial deform simulate soft.toml --load 'stroke 2' --springs 1 1 1 --seconds 1e-3 "
          "--out one");
  EXPECT_EQ(second.status, 0) << second.errors;
  EXPECT_THAT(second.output, HasSubstr("load 'stroke 2'"));
  EXPECT_THAT(
      run("haptrial deform simulate soft.toml --load 'stroke 4' --springs 1 1 1 --out four").errors,
      HasSubstr("allowed: stroke, stroke 1, stroke 2, stroke 3"));
  std::string moved = kSoftBall;
  const std::string stands = "shift = [0.0";
  moved.replace(moved.find(stands), stands.size(), "shift = [0.3");
  moved.replace(moved.find("core = {"), std::string::npos, R"(core.side = "-y"
[loads.stroke]
held = ["core"]
session = "study/S01.h5"
)");
  test::write_text(folder_ / "moved.toml", moved);
  const auto elsewhere = run("haptrial deform reference moved.toml --out elsewhere");
  EXPECT_EQ(elsewhere.status, 2);
  EXPECT_THAT(elsewhere.errors, HasSubstr("it must stand where the object stood in the session"));
}

TEST_F(DeformCommandTest, OptionsThatDoNothingAreRefused) {
  const auto refused = [&](const std::string& line, const std::string& sentence) {
    const auto result = run("haptrial deform " + line + " --out bad");
    EXPECT_EQ(result.status, 2) << line;
    EXPECT_THAT(result.errors, HasSubstr(sentence)) << line;
  };
  refused("calibrate bar.toml --grid 3 3 3", "--grid is for --constants grid");
  refused("calibrate bar.toml --share mass", "--share is 'mass'");
  refused("calibrate bar.toml --measure force", "--measure is 'force'");
  refused("calibrate bar.toml --made 31", "--made is 31");
  refused("calibrate bar.toml --samples 10", "--samples is for --method annealing");
  refused("calibrate bar.toml --method annealing --evaluations 20 --samples 50",
          "--samples is 50; allowed: up to --evaluations, 20");
  EXPECT_FALSE(fs::exists(folder_ / "bad.evaluations"));
  refused("simulate bar.toml --model elements --springs 1 1 1", "elements have none");
  refused("reference bar.toml --seconds 2", "--seconds is for --model dynamic or --motion");
  refused("reference bar.toml --damping 5", "--damping is for --model dynamic or --motion");
  refused("reference bar.toml --step 0.01", "--step is for --model dynamic");
  refused("reference bar.toml --motion --step 0.01", "--step is for --model dynamic");
  refused("skin bar.toml skin.obj pull.csv --format off", "allowed: .obj, .ply, .stl");
  EXPECT_THAT(run("haptrial deform skin --help").output, Not(HasSubstr("off")));
  const auto info_refuses = [&](const std::string& options, const std::string& sentence) {
    const auto result = run("haptrial deform info " + options);
    EXPECT_EQ(result.status, 2) << options;
    EXPECT_THAT(result.errors, HasSubstr(sentence)) << options;
  };
  info_refuses("bar.toml --scale 0.5", "--scale is for a mesh; bar.toml says it itself, in [body]");
  info_refuses("bar.toml --resolution 77", "--resolution is for a mesh");
  info_refuses("bar.node --resolution 77", "--resolution is for a surface");
  EXPECT_THAT(run("haptrial deform info bar.toml --springs 0 0 0").errors, HasSubstr("all 0"));
  EXPECT_THAT(run("haptrial deform info bar.xyz").errors, HasSubstr("allowed: .toml, .obj"));
}

TEST_F(DeformCommandTest, WhatIsInvertedInTheLastFrameIsSaid) {
  const auto torn =
      run("haptrial deform simulate bar.toml --load bend --springs 1e-9 1e-9 1e-9 --seconds 0.3 "
          "--frames 1 --out torn");
  ASSERT_EQ(torn.status, 0) << torn.errors;
  EXPECT_THAT(torn.output, HasSubstr("2 frames until 0.3 s"));
  EXPECT_THAT(torn.output, HasSubstr("inverted    up to "));
}

TEST_F(DeformCommandTest, ACalibrationThatMadeThingsWorseSaysSo) {
  const auto found =
      run("haptrial deform calibrate bar.toml --method annealing --evaluations 2 --samples 2 "
          "--range -2 2 --hand 0.02 1e-5 0.01 --out cal");
  ASSERT_EQ(found.status, 0) << found.errors;
  const auto numbers = json("cal/calibration.json");
  // A few wild guesses are all worse than a good hand.
  const bool worse = numbers["error_m"].get<double>() > numbers["hand_error_m"].get<double>();
  ASSERT_TRUE(worse) << found.output;
  EXPECT_THAT(found.output, HasSubstr("all in all worse than with constants set by hand"));
}

TEST_F(DeformCommandTest, BadInputGetsASentence) {
  const auto refused = [&](const std::string& line, const std::string& by,
                           const std::string& sentence) {
    write_bar_with(line, by);
    const auto result = run("haptrial deform reference bar.toml --out bad");
    EXPECT_EQ(result.status, 2) << by;
    EXPECT_THAT(result.errors, HasSubstr(sentence));
    EXPECT_FALSE(fs::exists(folder_ / "bad"));
  };
  refused("poisson = 0.0", "poisson = 0.5", "poisson is 0.5; allowed: above -1 and below 0.5");
  refused("young = 10e3", "young = 0.0", "young is 0; allowed: a number above 0 [Pa]");
  refused("held = [\"bottom\"]\npressures", "held = [\"corner\"]\npressures",
          "nothing holds the part of the body with vertex 0");
  refused("corner.nearest = [0.02, 0.02, 0.04]",
          "corner.low = [1.0, 1.0, 1.0]\n"
          "corner.high = [2.0, 2.0, 2.0]\n[loads.none]\nheld = [\"bottom\"]\nforces = [{ region = "
          "\"corner\", force = [1.0, 0.0, 0.0] }]",
          "load 'none': no vertex of the body is in the region 'corner'");
  refused("[loads.bend]\nheld = [\"bottom\"]\nforces = [{ region = \"top\"",
          "[loads.bend]\nheld = [\"bottom\"]\nforces = [{ region = \"bottom\"",
          "load 'bend' moves no vertex, and has no force on one that is not held");
  refused("[loads.bend]", "[loads.\"../bend\"]",
          "is \"../bend\"; allowed: letters, digits, -, _ and spaces");
  refused("block = [0.02, 0.02, 0.04]", "block = [0.02, 0.02, 0.04]\nmesh = \"a.obj\"",
          "body.block stands beside mesh or tetrahedra; keep one of the three");
  refused("law = \"linear\"",
          "law = \"neo-hookean\"\n[loads.tear]\nheld = [\"bottom\"]\n"
          "pressures = [{ region = \"top\", pressure = 1e7 }]",
          "load 'tear' tears or inverts the body");
  test::write_text(folder_ / "flat.node", "5 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 1 1 0\n");
  test::write_text(folder_ / "flat.ele", "2 4 0\n0 0 1 2 3\n1 0 1 2 4\n");
  const auto flat = run("haptrial deform info flat.node");
  EXPECT_EQ(flat.status, 2);
  EXPECT_THAT(flat.output, HasSubstr("inverted    0, flat 1: first tetrahedron 1"));
  EXPECT_THAT(flat.errors, HasSubstr("flat.node: tetrahedron 1 (vertices 0, 1, 2, 4) is flat"));
  test::write_text(folder_ / "flat.ele", "2 4 0\n0 0 1 2 3\n1 1 2 4 3\n");
  EXPECT_THAT(run("haptrial deform info flat.node").errors,
              HasSubstr("tetrahedron 1 (vertices 1, 2, 4, 3) is inverted"));
  test::write_text(folder_ / "bar.toml", kBar);
  EXPECT_THAT(run("haptrial deform reference bar.toml --max-memory 1e-6 --out bad").errors,
              HasSubstr("--max-memory allows 1e-06 GB"));
  EXPECT_THAT(run("haptrial deform simulate bar.toml --out bad").errors,
              HasSubstr("springs need --constants FILE"));
  EXPECT_THAT(run("haptrial deform calibrate bar.toml --constants all --out bad").errors,
              HasSubstr("--constants is 'all'"));
  EXPECT_THAT(run("haptrial deform reference bar.toml --load none --out bad").errors,
              HasSubstr("the load is 'none'"));
}

}  // namespace
}  // namespace haptrial
