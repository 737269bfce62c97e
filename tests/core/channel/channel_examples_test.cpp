#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "core/channel/channel_options.h"

namespace haptrial::channel {
namespace {

TEST(ChannelExamplesTest, DefinitionsOfTheDocumentAreRead) {
  std::ifstream in(HAPTRIAL_SOURCE_DIR "/docs/channels.md");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string opening = "```toml\n";
  int examples = 0;
  std::size_t begin = text.find(opening);
  for (; begin != std::string::npos; begin = text.find(opening, begin + 1)) {
    const std::size_t first = begin + opening.size();
    const std::string example = text.substr(first, text.find("```", first) - first);
    Table root = Table::parse(example, "docs/channels.md");
    EXPECT_GE(read_channels(root).size(), 1u) << example;
    EXPECT_NO_THROW(root.finish()) << example;
    ++examples;
  }
  EXPECT_GE(examples, 4);
}

}  // namespace
}  // namespace haptrial::channel
