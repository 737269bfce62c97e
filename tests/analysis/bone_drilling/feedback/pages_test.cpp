// Pages about procedures as text: what they hold, and that no name breaks out of its place.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/bone_drilling/feedback/procedure_page.h"
#include "analysis/bone_drilling/feedback/procedure_tables.h"
#include "analysis/bone_drilling/feedback/range_plot.h"
#include "analysis/bone_drilling/feedback/scene_mesh.h"
#include "analysis/bone_drilling/feedback/trainee_page.h"
#include "analysis/document/html.h"
#include "tests/analysis/bone_drilling/hand_made.h"

namespace haptrial::analysis::drilling::pages_test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kNasty = "</script><b onclick='x'>\"&{{SCENES}}";
constexpr const char* kTamed = "&lt;/script&gt;&lt;b onclick=&#39;x&#39;&gt;&quot;&amp;{{SCENES}}";

Procedure nasty_drilling() {
  bone::BoneModel model = test::block(12, 12, 8);
  model.structures.push_back({kNasty, {1.0, 1.0, 0.0}, 1.0, true});
  for (int i = 0; i < 12; ++i) {
    test::mark(model, {i, 6, 1}, 2);
  }
  Procedure p = test::procedure_on(std::move(model));
  p.participant = kNasty;
  p.session = kNasty;
  p.views.push_back({0, {0.006, 0.006, 0.3}, {0.006, 0.006, 0.0}});
  for (int k = 7; k > 2; --k) {
    for (int i = 3; i < 9; ++i) {
      test::remove_in_turn(p, {{i, 6, k}});
    }
  }
  return p;
}

TEST(FeedbackPageTest, NamesStayTextWhereverTheyStand) {
  const Procedure p = nasty_drilling();
  StudyBones bones;
  const Experts nobody;
  const Findings f = findings_of(p, nobody, bones);
  ProcedurePage page;
  page.findings = &f;
  page.experts = &nobody;
  page.scene = scene_json(f, {});
  page.expert_scene = page.scene;
  page.expert_name = kNasty;
  page.started = "2026-11-20T09:30:00Z";
  const std::string html = procedure_page(page);
  EXPECT_THAT(html, Not(HasSubstr("</script><b")));
  EXPECT_THAT(html, Not(HasSubstr("<b onclick")));
  EXPECT_THAT(html, HasSubstr(kTamed));
  EXPECT_THAT(html, HasSubstr("SIMULATED: the participant is a program"));
  EXPECT_THAT(html, HasSubstr("not judged: there are no experts"));
  const auto scene = nlohmann::json::parse(page.scene);
  EXPECT_EQ(scene["structures"][0]["name"], kNasty);

  TraineeProcedure done;
  done.summary = f.summary;
  done.page = "a\"b.html";
  const std::string all = trainee_page(kNasty, {done}, nobody);
  EXPECT_THAT(all, Not(HasSubstr("</script><b")));
  EXPECT_THAT(all, HasSubstr("href=\"a&quot;b.html\""));
}

TEST(FeedbackPageTest, AnOpenedStructureIsTheFirstThingThatIsSaid) {
  bone::BoneModel model = test::block(12, 12, 8);
  model.structures.push_back({"sigmoid sinus", {0.3, 0.4, 0.8}, 0.25, true});
  test::mark(model, {4, 6, 5}, 2);
  Procedure p = test::procedure_on(std::move(model));
  for (int i = 3; i < 9; ++i) {
    test::remove_in_turn(p, {{i, 6, 5}});
  }
  StudyBones bones;
  const Experts nobody;
  const Findings f = findings_of(p, nobody, bones);
  ProcedurePage page;
  page.findings = &f;
  page.experts = &nobody;
  page.scene = scene_json(f, {});
  const std::string html = procedure_page(page);
  const std::size_t said = html.find("You opened the sigmoid sinus after 0:00 (1 voxel removed).");
  ASSERT_NE(said, std::string::npos);
  EXPECT_LT(said, html.find("class=\"lead\""));
}

TEST(FeedbackPageTest, AFaultlessLookingPageOfAnUnlabelledBoneIsNoAllClear) {
  Procedure p = test::procedure_on(test::block(6, 6, 6));
  p.simulated = false;
  test::remove_in_turn(p, {{1, 1, 1}});
  StudyBones bones;
  const Experts nobody;
  const Findings f = findings_of(p, nobody, bones);
  ProcedurePage page;
  page.findings = &f;
  page.experts = &nobody;
  page.scene = scene_json(f, {});
  const std::string html = procedure_page(page);
  EXPECT_THAT(html, HasSubstr("Vital structures are unknown: this bone has none by a known name"));
  EXPECT_THAT(html, Not(HasSubstr("No turning burr reached")));
  EXPECT_THAT(html, Not(HasSubstr("SIMULATED")));
}

TEST(FeedbackPageTest, HeatAndBloodAreSaidWhereThereMayBeAny) {
  Procedure p = test::procedure_on(test::block(6, 6, 6));
  test::remove_in_turn(p, {{1, 1, 1}});
  StudyBones bones;
  const Experts nobody;
  const auto points_of = [&] { return summary_points(findings_of(p, nobody, bones), nobody); };
  EXPECT_THAT(points_of(), Not(testing::AnyOf(HasSubstr("Hottest"), HasSubstr("Blood"))));
  p.field = record::FieldRow{0, 4.25e-6, 1.5e-6, 2.75e-6, 49.34, 18.31};
  EXPECT_THAT(points_of(), HasSubstr("Hottest at the burr: 49.3 °C in a model; above the harmful "
                                     "temperature: 18.3 s"));
  EXPECT_THAT(points_of(), HasSubstr("Blood: 4.25 ml lost, 1.50 ml of it sucked away"));
  p.field->hottest = 0.0;
  EXPECT_THAT(points_of(), Not(HasSubstr("Hottest")));
}

std::vector<std::uint16_t> words_of(const nlohmann::json& text) {
  const std::string signs = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : text.get<std::string>()) {
    if (c == '=') {
      break;
    }
    group = group << 6U | static_cast<std::uint32_t>(signs.find(c));
    bits += 6;
    if (bits >= 8) {
      bits -= 8;
      bytes += static_cast<char>(group >> bits & 0xFFU);
    }
  }
  std::vector<std::uint16_t> words;
  for (std::size_t n = 0; n + 1 < bytes.size(); n += 2) {
    words.push_back(static_cast<std::uint16_t>(static_cast<unsigned char>(bytes[n]) |
                                               static_cast<unsigned char>(bytes[n + 1]) << 8U));
  }
  return words;
}

TEST(FeedbackPageTest, TheSceneHasTheRemovedVoxelsWhereTheyWereInTheWorld) {
  Procedure p = nasty_drilling();
  p.pose_WB = Eigen::Translation3d(0.1, -0.05, 0.02) *
              Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 3.0).normalized());
  StudyBones bones;
  const Findings f = findings_of(p, {}, bones);
  const auto scene = nlohmann::json::parse(scene_json(f, {}));
  const auto places = words_of(scene["removals"]["p"]);
  ASSERT_EQ(places.size(), 3 * p.removals.size());
  for (std::size_t n = 0; n < p.removals.size(); ++n) {
    const bone::Voxel& v = p.removals[n].voxel;
    const Eigen::Vector3d wanted = 1e3 * (p.pose_WB * p.bone->grid.centre(v));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double place =
          scene["low"][axis].get<double>() + scene["step"].get<double>() * places[3 * n + axis];
      EXPECT_NEAR(place, wanted[static_cast<Eigen::Index>(axis)], 1e-3);  // [mm]
    }
  }
}

TEST(FeedbackPageTest, ASurfaceIsMadeSmallerAndStaysWhereItWas) {
  // A ball of 20 voxels: all vertices stay near its surface.
  bone::BoneModel model = test::block(48, 48, 48);
  for (int k = 0; k < 48; ++k) {
    for (int j = 0; j < 48; ++j) {
      for (int i = 0; i < 48; ++i) {
        const double radius = (Eigen::Vector3d(i, j, k).array() - 23.5).matrix().norm();
        test::mark(model, {i, j, k}, radius < 20.0 ? 1 : 0);
      }
    }
  }
  const SceneMesh whole = scene_surface(model, 1000000);
  const SceneMesh small = scene_surface(model, 1000);
  EXPECT_GT(whole.triangles.size(), 10000u);
  EXPECT_LE(small.triangles.size(), 1000u);
  EXPECT_GT(small.triangles.size(), 500u);
  for (const auto& place : small.places) {
    const Eigen::Vector3d from_middle =
        Eigen::Vector3d(place[0], place[1], place[2]).array() - 23.5e-3;
    EXPECT_NEAR(from_middle.norm(), 20e-3, 1e-3);
  }
  EXPECT_TRUE(scene_structure(model, {false, false}, 100).triangles.empty());
}

TEST(FeedbackPageTest, APlotMarksFaultsAndHasTheRange) {
  RangePlot plot;
  plot.title = "<nerve>";
  plot.ranges = {{0.0, 1.0, 0.2, 0.4, 0.8}};
  plot.points = {{0.5, 0.3, false}, {0.5, 1.9, true}};
  const std::string svg = range_svg(plot);
  EXPECT_THAT(svg, HasSubstr("&lt;nerve&gt;"));
  EXPECT_THAT(svg, HasSubstr("class=\"faulty\""));
  EXPECT_THAT(svg, HasSubstr("class=\"band\""));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(Base64Test, TheVectorsOfItsStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace haptrial::analysis::drilling::pages_test
