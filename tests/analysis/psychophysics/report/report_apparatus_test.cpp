// Levels as measured: what a certificate's gain makes of them.

#include "analysis/psychophysics/report/report_apparatus.h"

#include <gtest/gtest.h>

#include <cmath>

namespace haptrial::analysis::trials {
namespace {

TEST(ReportApparatusTest, AMeasuredLevelHasTheUncertaintyOfBoth) {
  device::Certificate c;
  c.gain = 0.9;
  c.gain_low = 0.87;
  c.gain_high = 0.93;
  const Estimated exact = as_measured({100.0, 100.0, 100.0}, c);
  EXPECT_NEAR(exact.value, 90.0, 1e-12);
  EXPECT_NEAR(exact.low, 87.0, 1e-12);
  EXPECT_NEAR(exact.high, 93.0, 1e-12);
  const Estimated both = as_measured({100.0, 100.0 - 4.0 / 0.9, 100.0 + 4.0 / 0.9}, c);
  EXPECT_NEAR(both.low, 85.0, 1e-9) << "3 and 4 are 5";
  EXPECT_NEAR(both.high, 95.0, 1e-9);
  EXPECT_TRUE(std::isnan(as_measured({100.0}, c).low)) << "an interval that is not known";
}

TEST(ReportApparatusTest, OnlyLevelsThatGrowWithForceAreMeasured) {
  for (const char* unit : {"N", "mN", "N/m", "N·s/m"}) {
    EXPECT_TRUE(grows_with_force(unit)) << unit;
  }
  for (const char* unit : {"", "m", "Hz", "m/N", "degrees"}) {
    EXPECT_FALSE(grows_with_force(unit)) << unit;
  }
}

TEST(ReportApparatusTest, TheCertificateIsThatOfTheDefinition) {
  TrialsResult result;
  result.definition_name = "study.toml";
  result.definition = "[experiment]\nname = \"x\"\n";
  EXPECT_FALSE(certificate_of(result));
  EXPECT_TRUE(apparatus_findings(result).tables.empty());
  result.definition +=
      "[certificate]\nfile = \"arm.json\"\nchecksum = \"0123456789abcdef\"\ndevice = \"virtual\"\n"
      "gain = 0.87\ngain_low = 0.86\ngain_high = 0.88\n";
  const auto certificate = certificate_of(result);
  ASSERT_TRUE(certificate);
  EXPECT_EQ(certificate->gain, 0.87);
  EXPECT_FALSE(certificate->friction);
  EXPECT_EQ(apparatus_findings(result).tables.size(), 1u);
}

}  // namespace
}  // namespace haptrial::analysis::trials
