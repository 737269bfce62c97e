#include <gtest/gtest.h>

#include <string>

#include "core/base/definition/table.h"
#include "core/base/file_text.h"
#include "experiments/studies/psychophysics/trials_analysis.h"
#include "protocols/psychophysics/definition/trials_definition.h"
#include "protocols/psychophysics/trials_protocol.h"

namespace haptrial::experiments {
namespace {

/// The axis on which a report fits, as the procedure of the shipped experiment states it.
psychometric::Axis axis_with(const std::string& procedure) {
  std::string text = file_text(HAPTRIAL_SOURCE_DIR "/experiments/stiffness_discrimination.toml");
  const std::size_t begin = text.find("[procedure]");
  const std::size_t end = text.find("[practice]");
  text.replace(begin, end - begin, procedure);
  Table root = Table::parse(text, "study.toml");
  const auto definition = protocols::trials_protocol().read(root, "study.toml", nullptr);
  root.check();
  return plan_defaults(dynamic_cast<const protocols::TrialsDefinition&>(*definition))
      .procedures.at(0)
      .axis;
}

constexpr const char* kPest =
    "kind = \"pest\"\nvariable = \"level\"\nunit = \"N/m\"\nrange = [305.0, 600.0]\n"
    "scale = \"log10\"\norigin = 300.0\nstart = 500.0\nfirst_step = 0.2\nsmallest_step = 0.02\n"
    "largest_step = 0.4\nstop = { trials = 40 }\n";
constexpr const char* kPsi =
    "kind = \"psi\"\nvariable = \"level\"\nunit = \"N/m\"\nscale = \"log10\"\norigin = 300.0\n"
    "levels = { from = 305.0, to = 600.0, count = 30 }\nstop = { trials = 40 }\n";

TEST(TrialsAxisTest, AReportFitsOnTheScaleOfAnyProcedure) {
  const std::string tracks = "[[procedure.tracks]]\nname = \"one\"\n";
  for (const char* keys : {kPest, kPsi}) {
    for (const std::string& text :
         {std::string("[procedure]\n") + keys,
          std::string("[[procedures]]\nname = \"only\"\n") + keys,
          std::string("[procedure]\n") + keys + tracks, "[procedure]\n" + tracks + keys}) {
      const psychometric::Axis axis = axis_with(text);
      EXPECT_EQ(axis.scale, psychometric::Scale::kLog10) << text;
      EXPECT_EQ(axis.origin, 300.0) << text;
      EXPECT_EQ(axis.unit, "N/m") << text;
    }
  }
}

}  // namespace
}  // namespace haptrial::experiments
