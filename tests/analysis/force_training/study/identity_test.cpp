#include "analysis/force_training/study/identity.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "analysis/force_training/study/identity_json_internal.h"
#include "analysis/force_training/study/study_result.h"

namespace haptrial::analysis {
namespace {

const std::string kDefinition = "[hand]\nmass = 1.0\n[subject]\nweber = 0.1\n";

Identity identity_of(const std::string& definition, bool simulated = true, std::uint64_t seed = 1) {
  StudyResult study;
  study.sessions.emplace_back();
  auto& info = study.sessions.back().info;
  info.subject = "S1";
  info.simulated = simulated;
  info.seed = seed;
  info.definition = definition;
  return identities(study).at(0);
}

TEST(IdentityTest, SeedAndPopulationMakeAVirtualSubject) {
  const Identity one = identity_of(kDefinition);
  EXPECT_EQ(why_another(one, identity_of("# other words\n[subject]\nweber=1e-1\n[hand]\nmass=1\n")),
            "");
  EXPECT_EQ(why_another(one, identity_of(kDefinition + "[design]\ntrials = 3\n")), "");
  EXPECT_EQ(why_another(one, identity_of(kDefinition + "[pace]\npace = 1\n")), "");
  EXPECT_NE(why_another(one, identity_of("[hand]\nmass = 1.0\n[subject]\nweber = 0.2\n")), "");
  EXPECT_NE(why_another(one, identity_of("[hand]\nmass = 2.0\n[subject]\nweber = 0.1\n")), "");
  EXPECT_NE(why_another(one, identity_of(kDefinition, true, 2)), "");
  EXPECT_NE(why_another(identity_of(kDefinition + "[pace]\npace = 1\n"),
                        identity_of(kDefinition + "[pace]\npace = 2\n")),
            "");
}

TEST(IdentityTest, APersonIsTheIdentifier) {
  EXPECT_EQ(why_another(identity_of(kDefinition, false, 1), identity_of("", false, 2)), "");
  EXPECT_NE(why_another(identity_of(kDefinition, false), identity_of(kDefinition, true)), "");
}

TEST(IdentityTest, AVirtualSubjectWithoutADefinitionIsNobodyElse) {
  EXPECT_NE(why_another(identity_of(""), identity_of("")), "");
}

TEST(IdentityTest, ReadsBackFromJson) {
  const std::vector<Identity> all{identity_of(kDefinition, true, 18446744073709551615u),
                                  {"P\"2", false}};
  const auto read = identities_from(nlohmann::ordered_json::parse(to_json(all).dump()));
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].seed, all[0].seed);
  EXPECT_EQ(read[0].population, all[0].population);
  EXPECT_EQ(read[0].population.size(), 2u);
  EXPECT_EQ(read[1].subject, "P\"2");
  EXPECT_FALSE(read[1].seed);
}

}  // namespace
}  // namespace haptrial::analysis
