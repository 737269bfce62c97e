#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "analysis/files/json_pieces.h"
#include "analysis/files/sha256.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

/// The members of an object, lists element by element.
std::string in_pieces(const Json& object, std::vector<std::string>& pieces) {
  JsonPieces json([&](const std::string& text) { pieces.push_back(text); });
  for (const auto& [name, value] : object.items()) {
    if (value.is_array()) {
      const Json& list = value;
      json.list(name, list.size(), [&](std::size_t i) { return list[i].dump(2); });
    } else {
      json.member(name, value.dump(2));
    }
  }
  json.end();
  std::string all;
  for (const std::string& piece : pieces) {
    all += piece;
  }
  return all;
}

TEST(JsonPiecesTest, TheTextIsThatOfTheWholeObject) {
  const Json object{{"title", "lines\nand \"quotes\", \t"},
                    {"nothing", nullptr},
                    {"empty", Json::array()},
                    {"empty object", Json::object()},
                    {"numbers", {1, 2.5, 1e-300}},
                    {"nested", {{"list", {{{"a", 1}, {"b", Json::array()}}, "x\ny"}}, {"c", true}}},
                    {"objects", {{{"a", {1, 2}}}, {{"a", Json::object()}}}}};
  std::vector<std::string> pieces;
  EXPECT_EQ(in_pieces(object, pieces), object.dump(2) + "\n");
  EXPECT_EQ(pieces.size(), 1u);
}

TEST(JsonPiecesTest, AnObjectWithoutMembers) {
  std::vector<std::string> pieces;
  EXPECT_EQ(in_pieces(Json::object(), pieces), "{}\n");
}

TEST(JsonPiecesTest, LongListsAreGivenInPiecesOfAMebibyte) {
  Json object{{"list", Json::array()}};
  for (int i = 0; i < 3000; ++i) {
    object["list"].push_back({{"text", std::string(1000, 'x')}});
  }
  std::vector<std::string> pieces;
  EXPECT_EQ(in_pieces(object, pieces), object.dump(2) + "\n");
  EXPECT_EQ(pieces.size(), 3u);
  for (const std::string& piece : pieces) {
    EXPECT_LT(piece.size(), std::size_t{(1 << 20) + 2000});
  }
}

TEST(Sha256Test, AgreesWithTheStandardsExamples) {  // FIPS 180-2, appendix B
  EXPECT_EQ(sha256_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  const std::string million(1'000'000, 'a');
  const std::string digest = "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0";
  EXPECT_EQ(sha256_of(million), digest);
  const test::TemporaryFolder folder;
  write_text(folder / "a", million);
  EXPECT_EQ(sha256_of_file(folder / "a"), digest);
  EXPECT_THROW(sha256_of_file(folder / "b"), InputError);
}

}  // namespace

}  // namespace haptrial::analysis
