#include "core/deformable/touch/surface_samples.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/core/deformable/touch/soft_block.h"

namespace haptrial::deformable::surface_samples_test {
namespace {

TEST(SurfaceSamplesTest, ASampleIsMadeOfCornersThatEachOfItsFacesHas) {
  const Compliance body(test::soft_block(), test::soft_tissue());
  for (const int steps : {1, 2, 5}) {
    const SurfaceSamples samples(body.faces(), body.rest(), steps);
    for (std::size_t f = 0; f < body.faces().size(); ++f) {
      const Face& face = body.faces()[f];
      for (const std::int32_t number : samples.on(static_cast<std::int32_t>(f))) {
        const SurfaceSamples::Sample& sample = samples.samples[static_cast<std::size_t>(number)];
        EXPECT_NEAR(sample.weight.sum(), 1.0, 1e-12);
        for (const std::int32_t corner : sample.corners) {
          EXPECT_TRUE(std::ranges::find(face, corner) != face.end())
              << "face " << f << ", sample " << number << ", " << steps << " steps";
        }
      }
    }
  }
}

}  // namespace
}  // namespace haptrial::deformable::surface_samples_test
