// haptrial evaluate, as it is called from a shell.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "analysis/files/csv.h"
#include "core/base/fnv.h"
#include "core/geometry/files/mesh_io.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/object_rows.h"
#include "core/sound/wav.h"
#include "protocols/psychophysics/objects/object_files.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using testing::HasSubstr;
using testing::Not;

constexpr double kRadius = 50.0;    // of the sphere that mesh make gives [mm]
constexpr double kFriction = 0.25;  // Coulomb

class EvaluateCommandTest : public testing::Test {
 protected:
  EvaluateCommandTest() {
    rub("rubbed", 0.0, kFriction);
    EXPECT_EQ(run("haptrial mesh make sphere body.obj").status, 0);
  }

  /// @param start  of the way [s]
  void rub(const char* folder, double start, double coefficient) {
    fs::create_directory(folder_ / folder);
    std::ofstream poses(folder_ / folder / "poses.csv"), forces(folder_ / folder / "forces.csv");
    poses << "time_ms,x_mm,y_mm,z_mm\n";
    forces << "time_s,force_x_N,force_y_N,force_z_N\n";
    for (int i = 0; i < 5000; ++i) {
      const double t = 0.002 * i;
      const Vector3d n = normal(start + t);
      if (i % 5 == 0) {
        poses << 1e3 * t << ',' << kRadius * n.x() << ',' << kRadius * n.y() << ','
              << kRadius * n.z() << '\n';
      }
      const Vector3d way = (normal(start + t + 1e-4) - normal(start + t - 1e-4)).normalized();
      const Vector3d force = (1.0 + 0.4 * std::sin(5.0 * t)) * (n - coefficient * way);
      forces << t << ',' << force.x() << ',' << force.y() << ',' << force.z() << '\n';
    }
  }

  /// A mesh whose faces look the other way.
  void turn_faces(const char* from, const char* to) {
    geometry::Mesh mesh = geometry::read_mesh(folder_ / from);
    for (geometry::Triangle& t : mesh.triangles) {
      std::swap(t[0], t[1]);
    }
    geometry::write_mesh(folder_ / to, mesh);
  }

  static Vector3d normal(double t) {
    return Vector3d(0.7 * std::sin(2.1 * t), 1.0, 0.6 * std::cos(1.3 * t)).normalized();
  }
  test::CommandResult run(const std::string& line) {
    return test::run_command("cd '" + folder_.path().string() + "'\n" + line);
  }
  nlohmann::json numbers(const char* folder) {
    return nlohmann::json::parse(test::read_text(folder_ / folder / "evaluation.json"));
  }
  test::TemporaryFolder folder_;
};

TEST_F(EvaluateCommandTest, WritesReportAndNumbers) {
  const auto result =
      run("haptrial evaluate rubbed --mesh body.obj --registered --lag 0 --renderer proxy,voxel "
          "--resolution 32 --grating 4 1 0 0 --simulated --out out");
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, testing::StartsWith("SIMULATED RECORDING\n"));
  EXPECT_THAT(result.output, HasSubstr("best friction   0.2"));
  EXPECT_THAT(result.output, HasSubstr("report: out/report.html"));
  const std::string page = test::read_text(folder_ / "out/report.html");
  EXPECT_THAT(page, HasSubstr("SIMULATED RECORDING"));
  EXPECT_THAT(page, HasSubstr("<svg"));
  for (const char* picture : {"force-normal", "force-along-surface", "error-by-band", "residual"}) {
    EXPECT_GT(fs::file_size(folder_ / "out" / (std::string(picture) + ".png")), 1000U) << picture;
  }
  const auto json = numbers("out");
  EXPECT_TRUE(json["simulated"]);
  ASSERT_EQ(json["renderings"].size(), 3U) << "the proxy without friction and with, voxels without";
  EXPECT_NEAR(json["best_friction"]["friction"].get<double>(), kFriction, 0.05);
  const double missed = json["renderings"][0]["force_error"]["root_mean_square_N"];
  // The root mean square of mu N: what a rendering without friction must miss.
  EXPECT_NEAR(missed, kFriction * std::sqrt(1.0 + 0.5 * 0.4 * 0.4), 0.03);
  const auto& friction = json["identified"]["dynamic_friction"];
  EXPECT_NEAR(friction["value"].get<double>(), kFriction, 0.02);
  EXPECT_LT(friction["low_95"].get<double>(), friction["high_95"].get<double>());
  EXPECT_TRUE(json["identified"]["stiffness_N_per_m"]["high_95"].is_null()) << "a rigid body";
}

TEST_F(EvaluateCommandTest, TimesThatMayBeMillisecondsAreSaid) {
  const std::string line = "haptrial evaluate rubbed --mesh absent.obj --registered";
  EXPECT_THAT(run(line).errors, Not(HasSubstr("WARNING")));
  const auto slow = run("sed -i s/time_ms/time_s/ rubbed/poses.csv; " + line);
  EXPECT_THAT(
      slow.errors,
      HasSubstr("WARNING: implausible times of poses (9990 s with 0.1000 rows a second). Times "
                "are read as seconds and rates as hertz; are these milliseconds?"));
  EXPECT_THAT(slow.errors, Not(HasSubstr("times of forces")));
}

/// Another program reads the in-trajectory, and its forces are judged as ours are: here it presses
/// back by k times the depth, which is the recorded force without friction.
TEST_F(EvaluateCommandTest, ForcesOfAnotherProgramAreJudged) {
  const std::string line =
      "haptrial evaluate rubbed --mesh body.obj --registered --lag 0 --renderer proxy --stiffness "
      "500 ";
  ASSERT_EQ(run(line + "--out out").status, 0);
  const auto contact = analysis::CsvTable::load(folder_ / "out/contact.csv");
  std::ofstream mine(folder_ / "mine.csv");
  mine << "force_x_N,force_y_N,force_z_N\n";
  std::array<std::vector<double>, 3> out, in;
  for (std::size_t i = 0; i < 3; ++i) {
    out[i] = contact.numbers(contact.column(fmt::format("out_{}_m", "xyz"[i])));
    in[i] = contact.numbers(contact.column(fmt::format("in_{}_m", "xyz"[i])));
  }
  for (std::size_t row = 0; row < contact.rows(); ++row) {
    for (std::size_t i = 0; i < 3; ++i) {
      mine << 500.0 * (out[i][row] - in[i][row]) << (i < 2 ? "," : "\n");
    }
  }
  mine.close();
  const auto judged = run(line + "--rendered mine.csv --out judged");
  ASSERT_EQ(judged.status, 0) << judged.errors;
  EXPECT_THAT(judged.output, HasSubstr("\nmine "));
  const auto json = numbers("judged");
  ASSERT_EQ(json["other_programs"].size(), 1u);
  EXPECT_NEAR(json["other_programs"][0]["force_error"]["root_mean_square_N"].get<double>(),
              kFriction * std::sqrt(1.0 + 0.5 * 0.4 * 0.4), 0.01);
  EXPECT_THAT(test::read_text(folder_ / "judged/report.html"), HasSubstr(">mine<"));
  for (const std::string name : {"force", "proxy"}) {
    const auto twice = run("cp mine.csv " + name + ".csv; " + line + "--rendered " + name + ".csv");
    EXPECT_EQ(twice.status, 2) << name;
    EXPECT_THAT(twice.errors, HasSubstr("contact.csv has forces called " + name + ", too"));
  }
  const auto few = run("head -5 mine.csv > few.csv; " + line + "--rendered few.csv");
  EXPECT_EQ(few.status, 2);
  EXPECT_THAT(few.errors, HasSubstr("few.csv: few has 4 forces; allowed: "));
  const auto same = run("mkdir other; cp mine.csv other/mine.csv; " + line +
                        "--rendered mine.csv --rendered other/mine.csv");
  EXPECT_EQ(same.status, 2);
  EXPECT_THAT(same.errors, HasSubstr("other/mine.csv: another file of --rendered is called mine"));
}

/// Another hand on the same body, less than half as rough: its friction is not the first one's.
TEST_F(EvaluateCommandTest, WhatIsFittedOnOneRecordingIsTestedOnAnother) {
  rub("again", 11.3, kFriction);
  rub("smooth", 5.1, 0.1);
  const std::string line =
      "haptrial evaluate rubbed --mesh body.obj --registered --lag 0 --renderer proxy --simulated ";
  const auto result = run(line + "--test-on again --test-on smooth --out out");
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("on again"));
  EXPECT_THAT(test::read_text(folder_ / "out/report.html"),
              HasSubstr("Fitted on one recording, tested on another"));
  const auto cross = numbers("out")["cross_fit"];
  EXPECT_EQ(cross["recordings"], (nlohmann::json{"rubbed", "again", "smooth"}));
  const auto friction = [&](int i) { return cross["friction"][i].get<double>(); };
  EXPECT_NEAR(friction(0), kFriction, 0.05);
  EXPECT_NEAR(friction(1), friction(0), 0.02);
  EXPECT_LT(friction(2), 0.15);
  EXPECT_GT(cross["kept"][0][1].get<double>(), 0.95) << "as good as its own";
  EXPECT_LT(cross["kept"][0][2].get<double>(), 0.5) << "too rough for the smooth one";
  EXPECT_NEAR(cross["root_mean_square_N"][0][0].get<double>(),
              numbers("out")["best_friction"]["root_mean_square_with_N"].get<double>(), 1e-12);
  const auto refused = [&](const std::string& options, const std::string& why) {
    const auto bad = run(line + options);
    EXPECT_EQ(bad.status, 2) << options;
    EXPECT_THAT(bad.errors, HasSubstr(why)) << options;
  };
  refused("--test-on absent.csv", "absent.csv");
  const auto bad =
      run("haptrial evaluate rubbed --mesh body.obj --registered --lag 0 --renderer "
          "voxel --test-on again");
  EXPECT_EQ(bad.status, 2);
  EXPECT_THAT(bad.errors, HasSubstr("needs a renderer with friction"));
  EXPECT_EQ(run("haptrial evaluate --duck --test-on rubbed").status, 2);
}

/// The order of the two tables and the unit of the mesh are nobody's business but the command's.
TEST_F(EvaluateCommandTest, TablesComeInAnyOrder) {
  ASSERT_EQ(run("haptrial mesh repair body.obj body_mm.obj --scale 1000").status, 0);
  const std::string rest = " --registered --lag 0 --renderer proxy --friction 0.2 --out ";
  ASSERT_EQ(
      run("haptrial evaluate rubbed/forces.csv rubbed/poses.csv --mesh body.obj" + rest + "one")
          .status,
      0);
  ASSERT_EQ(run("haptrial evaluate rubbed/poses.csv rubbed/forces.csv --mesh body_mm.obj "
                "--units mm" +
                rest + "two")
                .status,
            0);
  const auto one = numbers("one"), two = numbers("two");
  ASSERT_EQ(one["renderings"].size(), 2U);
  EXPECT_EQ(one["renderings"][1]["friction"], 0.2);
  EXPECT_TRUE(one["best_friction"].is_null());
  for (int i = 0; i < 2; ++i) {
    const double error = one["renderings"][i]["force_error"]["root_mean_square_N"];
    EXPECT_NEAR(two["renderings"][i]["force_error"]["root_mean_square_N"], error, 1e-6);
  }
}

/// A ball that a virtual participant strokes in the first of two trials, 3 cm below the origin.
constexpr const char* kBallStudy = R"(
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
friction = { static = 0.2, dynamic = 0.2 }
fade_in = 0.0
record = true
[objects.other]
shape = "box"
size = [0.02, 0.02, 0.02]
centre = [0.0, 0.08, 0.0]
stiffness = 600.0
damping = 0.0
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

/// Forces that a session rendered come out again, though the chain must find where the ball was.
TEST_F(EvaluateCommandTest, ASessionIsARecordingOfItsContacts) {
  test::write_text(folder_ / "ball.toml", kBallStudy);
  ASSERT_EQ(run("haptrial mesh repair body.obj ball.obj --scale 0.5").status, 0);
  const auto rehearsed = run("haptrial dry-run ball.toml --out study");
  ASSERT_EQ(rehearsed.status, 0) << rehearsed.errors;
  const std::string line = "haptrial evaluate study/S01.h5 --mesh ball.obj --renderer proxy ";
  const auto result = run(line + "--stiffness 600 --friction 0.2 --out out");
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, testing::StartsWith("SIMULATED RECORDING\n"));
  const auto json = numbers("out");
  EXPECT_EQ(json["recording"], "S01.h5, ball in trial 1");
  const double without = json["renderings"][0]["force_error"]["root_mean_square_N"];
  const double with = json["renderings"][1]["force_error"]["root_mean_square_N"];
  EXPECT_LT(with, 0.3 * without) << "the session had friction";
  const auto& friction = json["identified"]["dynamic_friction"];
  EXPECT_NEAR(friction["value"].get<double>(), 0.2, 0.02);
  const auto& stiffness = json["identified"]["stiffness_N_per_m"];
  EXPECT_NEAR(stiffness["value"].get<double>(), 600.0, 3.0);

  // The table's force clock is late, which says nothing of the session, and the other way round.
  run("mkdir late; "
      "awk -F, 'NR == 1 { print; next } { printf \"%s,%g,%g,%g\\n\", $1, $2 / 2, $3 / 2, $4 / 2 }' "
      "rubbed/poses.csv > late/poses.csv; "
      "awk -F, 'NR == 1 { print; next } { printf \"%g,%s,%s,%s\\n\", $1 + 0.04, $2, $3, $4 }' "
      "rubbed/forces.csv > late/forces.csv");
  const std::string rest = " --mesh ball.obj --renderer proxy --stiffness 600 --out ";
  ASSERT_EQ(run("haptrial evaluate late" + rest + "alone").status, 0);
  const auto on_table = run("haptrial evaluate study/S01.h5 --test-on late" + rest + "on_table");
  ASSERT_EQ(on_table.status, 0) << on_table.errors;
  const auto on_session =
      run("haptrial evaluate late --test-on study/S01.h5" + rest + "on_session");
  ASSERT_EQ(on_session.status, 0) << on_session.errors;
  const double alone = numbers("alone")["best_friction"]["root_mean_square_with_N"];
  const auto error = [&](const char* folder, int i) {
    return numbers(folder)["cross_fit"]["root_mean_square_N"][i][i].get<double>();
  };
  EXPECT_EQ(numbers("on_session")["cross_fit"]["recordings"],
            (nlohmann::json{"late", "S01.h5, ball in trial 1 (simulated)"}));
  EXPECT_NEAR(error("on_table", 1), alone, 1e-9);
  EXPECT_NEAR(error("on_session", 0), alone, 1e-9);
  EXPECT_NEAR(error("on_session", 1), error("on_table", 0), 1e-9);

  const auto refused = [&](const std::string& options, const std::string& why) {
    const auto bad = run(line + options);
    EXPECT_EQ(bad.status, 2) << options;
    EXPECT_THAT(bad.errors, HasSubstr(why)) << options;
  };
  refused("--object other", "--object is 'other'; contacts are recorded with: ball");
  refused("--trial 2", "--trial is 2; the object was touched in the trials 1");
}

/// The study with another line below that of the ball's mesh, and with more at its end.
std::string ball_study_with(const std::string& line, const std::string& more = "") {
  std::string text = std::string(kBallStudy) + more;
  const std::string mesh = "mesh = \"ball.obj\"\n";
  return text.insert(text.find(mesh) + mesh.size(), line);
}

TEST_F(EvaluateCommandTest, TheToolOfASessionIsAsLargeAsItsDefinitionSays) {
  test::write_text(folder_ / "ball.toml", ball_study_with("tool_radius = 0.005\n"));
  ASSERT_EQ(run("haptrial mesh repair body.obj ball.obj --scale 0.5").status, 0);
  ASSERT_EQ(run("haptrial dry-run ball.toml --out study").status, 0);
  const std::string line =
      "haptrial evaluate study/S01.h5 --mesh ball.obj --renderer proxy --stiffness 600 "
      "--friction 0.2 --out ";
  for (const char* out : {"own", "five --radius 5", "point --radius 0"}) {
    const auto result = run(line + out);
    ASSERT_EQ(result.status, 0) << result.errors;
  }
  const auto error = [&](const char* folder) {
    return numbers(folder)["renderings"][1]["force_error"]["root_mean_square_N"].get<double>();
  };
  EXPECT_EQ(error("own"), error("five"));
  EXPECT_LT(error("own"), 0.5 * error("point"));
}

TEST_F(EvaluateCommandTest, AnObjectIsFeltByADeviceThatIsNotTheFirst) {
  test::write_text(folder_ / "ball.toml",
                   ball_study_with("device = \"right\"\n",
                                   "[devices.left]\nstart = [-0.06, 0.0, 0.0]\n"
                                   "[devices.right]\nstart = [0.0, 0.0, 0.0]\n"));
  std::string text = test::read_text(folder_ / "ball.toml");
  const std::string action = "explore = { do";
  test::write_text(folder_ / "ball.toml",
                   text.replace(text.find(action), action.size(), "explore.right = { do"));
  ASSERT_EQ(run("haptrial mesh repair body.obj ball.obj --scale 0.5").status, 0);
  const auto rehearsed = run("haptrial dry-run ball.toml --out study");
  ASSERT_EQ(rehearsed.status, 0) << rehearsed.errors;
  const auto result =
      run("haptrial evaluate study/S01.h5 --mesh ball.obj --renderer proxy --stiffness 600 "
          "--friction 0.2 --out out");
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto json = numbers("out");
  EXPECT_EQ(json["recording"], "S01.h5, ball in trial 1");
  EXPECT_NEAR(json["identified"]["stiffness_N_per_m"]["value"].get<double>(), 600.0, 3.0);
}

/// The file keeps the checksum of the mesh: the same recording is no recording of another body.
TEST_F(EvaluateCommandTest, ARecordingIsNotReplayedWithAnotherMesh) {
  test::write_text(folder_ / "ball.toml", kBallStudy);
  ASSERT_EQ(run("haptrial mesh repair body.obj ball.obj --scale 0.5").status, 0);
  ASSERT_EQ(run("haptrial dry-run ball.toml --out study").status, 0);
  const auto rows = record::SessionReader(folder_ / "study/S01.h5").rows<record::ObjectFileRow>();
  ASSERT_EQ(rows.size(), 1U);
  const std::string bytes = test::read_text(folder_ / "ball.obj");
  EXPECT_EQ(rows[0].name, "ball");
  EXPECT_EQ(rows[0].file, "ball.obj");
  EXPECT_EQ(rows[0].bytes, bytes.size());
  EXPECT_EQ(rows[0].checksum, fnv1a(bytes));
  const std::string again =
      "haptrial run ball.toml --subject S01 --device replay:study/S01.h5 --out again";
  ASSERT_EQ(run(again).status, 0);

  ASSERT_EQ(run("haptrial mesh repair body.obj ball.obj --scale 0.6 --overwrite").status, 0);
  const std::string other = fmt::format("{:016x}", fnv1a(test::read_text(folder_ / "ball.obj")));
  const auto refused = run(again + "_2");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors,
              HasSubstr("was recorded with another file of objects.ball: 'ball.obj' has the "
                        "checksum " +
                        other + ", the recording " + fmt::format("{:016x}", rows[0].checksum) +
                        "; replay it with the same file"));
  // Sessions of one study that felt different meshes are told apart.
  ASSERT_EQ(run("haptrial dry-run ball.toml --out other").status, 0);
  std::filesystem::copy_file(folder_ / "other/S01.h5", folder_ / "study/S02.h5");
  const auto analysed = run("haptrial analyze study");
  EXPECT_EQ(analysed.status, 0) << analysed.errors;
  const std::string sentence = fmt::format(
      "objects.ball was not the same file in all sessions, which are analysed together "
      "all the same: 'ball.obj' with the checksum {:016x} in S01.h5; 'ball.obj' with "
      "the checksum {} in S02.h5.",
      rows[0].checksum, other);
  EXPECT_THAT(analysed.output, HasSubstr(sentence));
  EXPECT_THAT(test::read_text(folder_ / "study/report.md"), HasSubstr("not the same file"));
  EXPECT_THAT(run("haptrial analyze other").output, Not(HasSubstr("not the same file")));

  // The same for a session that is gone on with.
  std::vector<protocols::TrialObject> objects(1);
  objects[0].name = "ball";
  objects[0].file = "ball.obj";
  protocols::load_objects(objects, folder_.path());
  const record::SessionReader recorded(folder_ / "study/S01.h5");
  const auto files = [&] { return protocols::object_files(objects, {}); };
  EXPECT_THAT(test::message_of([&] { protocols::check_object_files(recorded, files(), "resume"); }),
              HasSubstr("; resume it with the same file"));
  test::write_text(folder_ / "ball.obj", bytes);
  protocols::load_objects(objects, folder_.path());
  EXPECT_NO_THROW(protocols::check_object_files(recorded, files(), "resume"));
}

/// A sound is a stimulus as a mesh is.
TEST_F(EvaluateCommandTest, SessionsThatHeardOtherRecordingsAreToldApart) {
  const auto record_beep = [this](float level) {
    sound::WavWriter writer(folder_ / "beep.wav", 48'000, true);
    writer.write(std::vector<float>(480, level));
    writer.finish();
    return fmt::format("{:016x}", fnv1a(test::read_text(folder_ / "beep.wav")));
  };
  std::string study = kBallStudy;
  study.replace(study.find("mesh = \"ball.obj\""), 17,
                "shape = \"box\"\nsize = [0.02, 0.02, 0.02]");
  study.replace(study.find("participants = 1"), 16, "participants = 2");
  study += "[sounds.beep]\ntype = \"file\"\nfile = \"beep.wav\"\n";
  test::write_text(folder_ / "beep.toml", study);
  const std::string first = record_beep(0.1F);
  ASSERT_EQ(run("haptrial dry-run beep.toml --subjects 1 --out study").status, 0);
  const std::string second = record_beep(0.2F);
  const auto refused =
      run("haptrial run beep.toml --subject S01 --device replay:study/S01.h5 --out again");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("was recorded with another file of sounds.beep"));
  ASSERT_EQ(run("haptrial dry-run beep.toml --subjects 2 --out other").status, 0);
  fs::copy_file(folder_ / "other/S02.h5", folder_ / "study/S02.h5");
  EXPECT_THAT(run("haptrial analyze study").output,
              testing::AllOf(HasSubstr("sounds.beep was not the same file in all sessions"),
                             HasSubstr(first + " in S01.h5"), HasSubstr(second + " in S02.h5")));
}

TEST_F(EvaluateCommandTest, WhatIsDoubtfulIsSaid) {
  geometry::Mesh mesh = geometry::read_mesh(folder_ / "body.obj");
  for (Vector3d& v : mesh.vertices) {
    v += Vector3d(0.0, -0.3, 0.0);
  }
  geometry::write_mesh(folder_ / "far.obj", mesh);
  const auto far = run("haptrial evaluate rubbed --mesh far.obj --registered --lag 0");
  EXPECT_EQ(far.status, 0) << far.errors;
  EXPECT_THAT(far.output, HasSubstr("The path does not lie on the body"));
  // A stretch that was named as free is none. A load of nothing is one that is known.
  const auto touched =
      run("haptrial evaluate rubbed --mesh body.obj --registered --lag 0 --free 0 2");
  EXPECT_THAT(touched.output, HasSubstr("perhaps something is touched there"));
  const auto known =
      run("haptrial evaluate rubbed --mesh body.obj --registered --lag 0 --load 0 0 0 0 0 0");
  EXPECT_EQ(known.status, 0) << known.errors;
  EXPECT_THAT(known.output, Not(HasSubstr("No stretch without contact was named")));
  const std::string line =
      "haptrial evaluate rubbed --mesh body.obj --registered --lag 0 "
      "--renderer proxy --friction 0.2 --load ";
  EXPECT_EQ(run(line + "0 -.01 0 -.02 0 0 --out short").status, 0);
  EXPECT_EQ(run(line + "0 -0.01 0 -0.02 0 0 --out whole").status, 0);
  EXPECT_EQ(numbers("short")["renderings"][0]["force_error"],
            numbers("whole")["renderings"][0]["force_error"]);
}

TEST_F(EvaluateCommandTest, BadInputGetsASentence) {
  const auto refused = [&](const std::string& line, const std::string& why) {
    const auto result = run("haptrial evaluate " + line);
    EXPECT_EQ(result.status, 2) << line;
    EXPECT_THAT(result.errors, HasSubstr(why)) << line;
  };
  const std::string good = "rubbed --mesh body.obj --registered ";
  refused("absent.csv --mesh body.obj", "absent.csv");
  refused("rubbed --mesh absent.obj", "absent.obj");
  refused(good + "--units inch", "--units is 'inch'; allowed: m, cm, mm");
  refused(good + "--renderer proxi", "--renderer is 'proxi'");
  refused(good + "--stiffness 0", "--stiffness");
  refused(good + "--rate 1", "--rate");
  refused(good + "--friction -0.1", "--friction");
  refused(good + "--sensor 1 1 0 0", "--sensor has the length 1.414");
  refused(good + "--free 2 1", "--free is from 2 to 1 s");
  refused(good + "--free 1 2 3", "--free has 3 times");
  refused(good + "--grating 4 0 0 0", "--grating: the axis has no length");
  refused(good + "--lag 90000", "--lag");
  refused(good + "--lag 0 --free 0.0 0.01", "40 samples");
  refused("rubbed/poses.csv --mesh body.obj", "force_x");
  refused(good + "--trial 1", "--object and --trial are for a session file (.h5)");
  refused("absent.h5 --mesh body.obj", "absent.h5");
  refused("", "evaluate needs RECORDING and --mesh, or --duck");
  refused("rubbed", "evaluate needs RECORDING and --mesh, or --duck");
  refused("rubbed --duck", "--duck is given with a recording");
  refused("--duck --seed one", "--seed");
  refused(good + "--seed 2", "--seed is for --duck");
  // A mesh in another unit, an inside-out one, a recording without contact or against its forces.
  refused("rubbed --mesh body.obj --units mm", "the contacts span 0.0");
  run("haptrial mesh repair body.obj large.obj --scale 1000");
  refused("rubbed --mesh large.obj", "--units must be the unit of the mesh: m, cm or mm");
  refused("rubbed --mesh large.obj --registered --lag 0", "the contacts span 0.0");
  turn_faces("body.obj", "inwards.obj");
  refused("rubbed --mesh inwards.obj --registered", "inwards.obj: its faces look inwards");
  refused(good + "--lag 0 --on-body", "do the forces act on the body (--on-body)");
  run("mkdir air; cp rubbed/poses.csv air; awk -F, 'NR == 1 { print; next } "
      "{ printf \"%s,%g,0,0\\n\", $1, 1e-4 * (NR % 7) }' rubbed/forces.csv > air/forces.csv");
  refused("air --mesh body.obj --lag 0", "0 of 1000 poses are in contact");
  refused(good + "--load 0 0 0 0 0 0 --free 0 1", "--load stands beside --free");
  // The recordings are too short for their lag, without any change, and with forces in another
  // unit.
  run("mkdir short still strong; cp rubbed/poses.csv strong; cp rubbed/forces.csv short; "
      "cp rubbed/forces.csv still; awk 'NR <= 201' rubbed/poses.csv > short/poses.csv; "
      "awk -F, 'NR == 1 { print; next } { print $1 \",1,2,3\" }' rubbed/poses.csv > "
      "still/poses.csv; "
      "awk -F, 'NR == 1 { print; next } { printf \"%s,%g,%g,%g\\n\", $1, 1e3 * $2, 1e3 * $3, 1e3 * "
      "$4 }' rubbed/forces.csv > strong/forces.csv");
  refused("short --mesh body.obj",
          "poses and forces overlap for 1.99 s; allowed where their lag is");
  refused("still --mesh body.obj", "poses.csv: its poses never change");
  refused("strong --mesh body.obj --registered --lag 0", "in another unit");
  run("mkdir empty; mkdir out; touch out/file");
  refused("empty --mesh body.obj", "empty: holds 0 tables");
  refused(good + "--lag 0 --renderer proxy --out out", "out");
}

}  // namespace
}  // namespace haptrial
