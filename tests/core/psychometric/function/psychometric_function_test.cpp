#include "core/psychometric/function/psychometric_function.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "tests/support/message_of.h"

namespace haptrial::psychometric {
namespace {

const std::vector<Sigmoid> kAll{Sigmoid::kLogistic, Sigmoid::kGaussian, Sigmoid::kGumbel,
                                Sigmoid::kReversedGumbel, Sigmoid::kCauchy};

std::vector<PsychometricParameters> every_kind() {
  std::vector<PsychometricParameters> all;
  for (Sigmoid sigmoid : kAll) {
    for (Scale scale : {Scale::kLinear, Scale::kLog10, Scale::kNaturalLog, Scale::kDecibel}) {
      for (bool falling : {false, true}) {
        PsychometricParameters p;
        p.sigmoid = sigmoid;
        p.axis = {scale, 2.0};
        p.threshold = 5.0;
        p.width = scale == Scale::kDecibel ? 6.0 : 0.4;
        p.guess = 0.25;
        p.lapse = 0.03;
        p.share = 0.6;
        p.falling = falling;
        all.push_back(p);
      }
    }
  }
  return all;
}

TEST(SigmoidTest, ValuesOfTheirDefinitions) {
  EXPECT_DOUBLE_EQ(sigmoid(Sigmoid::kLogistic, std::log(3.0)), 0.75);
  EXPECT_NEAR(sigmoid(Sigmoid::kGaussian, 1.959963984540054), 0.975, 1e-15);
  EXPECT_NEAR(sigmoid(Sigmoid::kGumbel, 0.0), 1.0 - std::exp(-1.0), 1e-15);
  EXPECT_NEAR(sigmoid(Sigmoid::kReversedGumbel, 0.0), std::exp(-1.0), 1e-15);
  EXPECT_DOUBLE_EQ(sigmoid(Sigmoid::kCauchy, 1.0), 0.75);
  EXPECT_DOUBLE_EQ(sigmoid(Sigmoid::kCauchy, -1.0), 0.25);
}

TEST(SigmoidTest, BothSidesAddToOneAndTheDensityIsTheDerivative) {
  for (Sigmoid kind : kAll) {
    for (double z = -4.0; z <= 4.0; z += 0.25) {
      EXPECT_NEAR(sigmoid(kind, z) + sigmoid_above(kind, z), 1.0, 1e-15);
      const double h = 1e-5;
      const double slope = (sigmoid(kind, z + h) - sigmoid(kind, z - h)) / (2.0 * h);
      EXPECT_NEAR(sigmoid_density(kind, z), slope, 1e-9) << static_cast<int>(kind) << " " << z;
    }
  }
}

TEST(SigmoidTest, QuantilesAreTheInverse) {
  for (Sigmoid kind : kAll) {
    for (double p : {1e-9, 0.05, 0.3, 0.5, 0.7, 0.95, 0.999}) {
      EXPECT_NEAR(sigmoid(kind, sigmoid_quantile(kind, p)) / p, 1.0, 1e-9);
    }
    EXPECT_THROW(sigmoid_quantile(kind, 0.0), std::invalid_argument);
    EXPECT_THROW(sigmoid_quantile(kind, 1.0), std::invalid_argument);
  }
}

// Points against differences of the shares, lanes against points.
TEST(SigmoidTest, PointsAndLanesAgree) {
  for (Sigmoid kind : kAll) {
    for (double first = -40.0; first <= 40.0; first += 2.5) {
      double z[SigmoidLanes::kCount];
      for (std::size_t i = 0; i < SigmoidLanes::kCount; ++i) {
        z[i] = first + 0.31 * static_cast<double>(i);
      }
      SigmoidLanes lanes;
      sigmoid_lanes(kind, z, lanes);
      for (std::size_t i = 0; i < SigmoidLanes::kCount; ++i) {
        const SigmoidPoint point = sigmoid_point(kind, z[i]);
        EXPECT_NEAR(lanes.share[i], point.share, 1e-11 * point.share);
        EXPECT_NEAR(lanes.beyond[i], point.beyond, 1e-11 * point.beyond);
        EXPECT_NEAR(lanes.density[i], point.density, 1e-14 * point.density);
        EXPECT_NEAR(lanes.bend[i], point.bend, 1e-14 * (point.density + std::abs(point.bend)));
        const double h = 1e-5;
        const double bend =
            (sigmoid_density(kind, z[i] + h) - sigmoid_density(kind, z[i] - h)) / (2.0 * h);
        EXPECT_NEAR(point.bend, bend, 1e-9) << static_cast<int>(kind) << " " << z[i];
      }
    }
  }
}

// The tails of the Gaussian against those of the C library.
TEST(SigmoidTest, TheGaussianIsThatOfTheLibrary) {
  for (double z = -37.0; z <= 37.0; z += 0.0137) {
    const double share = 0.5 * std::erfc(-z / std::numbers::sqrt2);
    // An exponent of z^2 / 2 that is rounded, in both.
    EXPECT_NEAR(sigmoid(Sigmoid::kGaussian, z) / share, 1.0, 2e-15 + 3.4e-16 * z * z) << z;
    EXPECT_EQ(sigmoid(Sigmoid::kGaussian, z), sigmoid_above(Sigmoid::kGaussian, -z));
  }
  const double infinity = std::numeric_limits<double>::infinity();
  for (Sigmoid kind : kAll) {
    EXPECT_EQ(sigmoid(kind, -infinity), 0.0);
    EXPECT_EQ(sigmoid(kind, infinity), 1.0);
    EXPECT_TRUE(std::isnan(sigmoid(kind, std::nan(""))));
  }
}

TEST(SigmoidTest, NamesOfTheField) {
  EXPECT_EQ(sigmoid_named("Weibull").sigmoid, Sigmoid::kGumbel);
  EXPECT_FALSE(sigmoid_named("Weibull").falling);
  EXPECT_TRUE(sigmoid_named("neg_rWeibull").falling);
  EXPECT_TRUE(sigmoid_named("neg_rWeibull").logarithmic);
  EXPECT_EQ(sigmoid_named("neg_rWeibull").sigmoid, Sigmoid::kReversedGumbel);
  EXPECT_EQ(sigmoid_named("gauss").sigmoid, Sigmoid::kGaussian);
  for (const SigmoidName& known : sigmoid_names()) {
    EXPECT_EQ(sigmoid_named(known.name).sigmoid, known.form.sigmoid) << known.name;
  }
  EXPECT_EQ(sigmoid_named("weibull").sigmoid, Sigmoid::kGumbel);
  EXPECT_TRUE(sigmoid_named("weibull").logarithmic);
  EXPECT_EQ(sigmoid_named("logn").sigmoid, Sigmoid::kGaussian);
  EXPECT_FALSE(sigmoid_named("rgumbel").logarithmic);
  EXPECT_NE(
      test::message_of<std::invalid_argument>([] { sigmoid_named("weibul"); }).find("weibull"),
      std::string::npos);
}

TEST(PsychometricFunctionTest, TheInverseGivesTheLevelBack) {
  for (const auto& parameters : every_kind()) {
    const PsychometricFunction psi(parameters);
    for (double p = 0.26; p < 0.97; p += 0.05) {
      const double level = psi.level_for(p);
      EXPECT_NEAR(psi(level), p, 1e-12);
      EXPECT_NEAR(psi.level_for(psi(level)), level, 1e-9 * level);
    }
    EXPECT_THROW(psi.level_for(0.25), std::invalid_argument);
    EXPECT_THROW(psi.level_for(0.97), std::invalid_argument);
  }
}

TEST(PsychometricFunctionTest, ThresholdAndWidthAreWhereTheySay) {
  for (const auto& p : every_kind()) {
    const PsychometricFunction psi(p);
    const auto unscaled = [&](double x) {
      const double share = (psi.at(x) - p.guess) / (1.0 - p.guess - p.lapse);
      return share;
    };
    const double m = p.axis.at(p.threshold);
    EXPECT_NEAR(unscaled(m), 0.6, 1e-12);
    // Both ends of the width, from the inverse at the tails.
    const auto scaled = [&](double share) { return p.guess + (1.0 - p.guess - p.lapse) * share; };
    const double distance = psi.x_for(scaled(0.95)) - psi.x_for(scaled(0.05));
    EXPECT_NEAR(p.falling ? -distance : distance, p.width, 1e-11 * p.width);
    EXPECT_NEAR(psi.level_for_share(0.95), psi.level_for(scaled(0.95)), 1e-11);
    // The same function from its curve and x.
    auto other = p;
    other.threshold = 77.0;
    const PsychometricFunction same(other, curve_of(p), m);
    EXPECT_NEAR(same.parameters().threshold, p.threshold, 1e-13);
    EXPECT_EQ(same.at(m + 0.1), psi.at(m + 0.1));
  }
}

TEST(PsychometricFunctionTest, DerivativesAgreeWithDifferences) {
  for (const auto& p : every_kind()) {
    const PsychometricFunction psi(p);
    for (double level : {4.0, 4.9, 5.0, 5.2, 7.0}) {
      const double h = 1e-5;
      const double slope = (psi(level + h) - psi(level - h)) / (2.0 * h);
      EXPECT_NEAR(psi.derivative(level), slope, 1e-6 * (1.0 + std::abs(slope)));
    }
  }
}

// Watson 2017: p = 1 - lapse - (1 - guess - lapse) exp(-10^(slope (x - threshold) / 20)) in dB.
TEST(PsychometricFunctionTest, AWeibullInDecibelIsThatOfWatson) {
  PsychometricParameters p;
  p.sigmoid = sigmoid_named("weibull").sigmoid;
  p.axis = {Scale::kDecibel, 0.0};
  p.threshold = std::pow(10.0, -20.0 / 20.0);
  p.share = 1.0 - std::exp(-1.0);
  p.width = width_of_rate(p.sigmoid, 3.5 * std::numbers::ln10 / 20.0);
  p.guess = 0.5;
  p.lapse = 0.02;
  const PsychometricFunction psi(p);
  for (double x = -40.0; x <= 0.0; x += 1.0) {
    const double watson = 0.98 - 0.48 * std::exp(-std::pow(10.0, 3.5 * (x + 20.0) / 20.0));
    EXPECT_NEAR(psi.at(x), watson, 1e-14);
    EXPECT_NEAR(psi(std::pow(10.0, x / 20.0)), watson, 1e-14);
  }
}

TEST(PsychometricFunctionTest, AGaussianOfRateOneOverSigmaHasThatSigma) {
  PsychometricParameters p;
  p.sigmoid = Sigmoid::kGaussian;
  p.threshold = 3.0;
  p.width = width_of_rate(p.sigmoid, 1.0 / 0.7);
  EXPECT_NEAR(p.width, 2.0 * 1.6448536269514722 * 0.7, 1e-12);
  EXPECT_NEAR(PsychometricFunction(p)(3.7), 0.8413447460685429, 1e-14);
}

TEST(PsychometricFunctionTest, LevelsAtTheOriginOfALogarithmGiveTheGuess) {
  PsychometricParameters p;
  p.sigmoid = Sigmoid::kGumbel;
  p.axis = {Scale::kLog10, 0.0};
  p.threshold = 1.0;
  p.guess = 0.5;
  const PsychometricFunction psi(p);
  EXPECT_EQ(psi(0.0), 0.5);
  EXPECT_EQ(psi(-3.0), 0.5);
  EXPECT_EQ(psi.derivative(0.0), 0.0);
}

TEST(PsychometricFunctionTest, ParametersOutOfBoundsAreNamed) {
  const auto message = [](auto&& change) {
    PsychometricParameters p;
    change(p);
    return test::message_of<std::invalid_argument>([&] { PsychometricFunction psi(p); });
  };
  EXPECT_NE(message([](auto& p) { p.width = 0.0; }).find("width"), std::string::npos);
  EXPECT_NE(message([](auto& p) { p.guess = -0.1; }).find("guess"), std::string::npos);
  EXPECT_NE(message([](auto& p) { p.lapse = 1.0; }).find("lapse"), std::string::npos);
  EXPECT_NE(message([](auto& p) { p.share = 1.0; }).find("share"), std::string::npos);
  EXPECT_NE(message([](auto& p) { p.tail = 0.5; }).find("tail"), std::string::npos);
  EXPECT_NE(message([](auto& p) { p.axis.scale = Scale::kLog10; }).find("threshold"),
            std::string::npos);
}

TEST(AxisTest, LevelsAndUnits) {
  for (Scale scale : {Scale::kLinear, Scale::kLog10, Scale::kNaturalLog, Scale::kDecibel}) {
    const Axis axis{scale, 2.0, "N/m"};
    EXPECT_NEAR(axis.level(axis.at(302.0)), 302.0, 1e-10);
    const double h = 1e-4;
    EXPECT_NEAR(axis.gradient(302.0), (axis.at(302.0 + h) - axis.at(302.0 - h)) / (2.0 * h), 1e-9);
  }
  EXPECT_DOUBLE_EQ((Axis{Scale::kNaturalLog, 1.0}.at(1.0 + std::numbers::e)), 1.0);
  EXPECT_DOUBLE_EQ((Axis{Scale::kDecibel, 0.0}.at(100.0)), 40.0);
  EXPECT_EQ((Axis{Scale::kLinear, 0.0, "N/m"}.x_unit()), "N/m");
  EXPECT_EQ((Axis{Scale::kLog10, 0.0, "N/m"}.x_unit()), "log10(N/m)");
  EXPECT_EQ((Axis{Scale::kNaturalLog, 0.0, "N/m"}.x_unit()), "ln(N/m)");
  EXPECT_EQ((Axis{Scale::kDecibel, 0.0, "N/m"}.x_unit()), "dB re 1 N/m");
}

}  // namespace
}  // namespace haptrial::psychometric
