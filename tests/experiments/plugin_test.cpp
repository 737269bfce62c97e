// Plug-ins that the command loads, and the sentences with which it refuses them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "tests/experiments/command.h"
#include "tests/support/temporary_folder.h"

namespace haptrial {
namespace {

using test::CommandResult;
using test::run_command;
using testing::HasSubstr;

std::string stand_in(const std::string& name) {
  return HAPTRIAL_BINARY_DIR "/libstand_in_plugin" + name + ".so";
}

/// One sentence on standard error, and status 2.
void expect_line_refused(const std::string& line, const std::string& part) {
  const CommandResult result = run_command(line);
  EXPECT_EQ(result.status, 2) << result.output << result.errors;
  EXPECT_THAT(result.errors, HasSubstr(part));
  EXPECT_EQ(result.errors.find('\n'), result.errors.size() - 1) << result.errors;
}

void expect_plugin_refused(const std::string& file, const std::string& part) {
  expect_line_refused("haptrial --plugin '" + file + "' devices", part);
}

/// A definition whose one field only the stand-in has.
std::string calm_definition(const test::TemporaryFolder& folder) {
  std::ifstream shipped(HAPTRIAL_SOURCE_DIR "/experiments/first_experiment.toml");
  std::string text{std::istreambuf_iterator<char>(shipped), {}};
  text += "\n[fields.quiet]\ntype = \"calm\"\n";
  const std::string file = (folder / "calm.toml").string();
  std::ofstream(file) << text;
  return "'" + file + "'";
}

TEST(PluginTest, AFileThatIsNotThereOrNoSharedObjectIsRefused) {
  const test::TemporaryFolder folder;
  const std::string text = (folder / "text.so").string();
  std::ofstream(text) << "not an object\n";
  expect_plugin_refused("nowhere.so", "there is no file nowhere.so");
  expect_plugin_refused(folder.path().string(), ": is a directory");
  expect_plugin_refused(text, "is not a shared object");
  expect_line_refused("haptrial devices --plugin", "--plugin has no value");
}

TEST(PluginTest, ASharedObjectThatIsNoPluginOfThisProgramIsRefused) {
  expect_plugin_refused(HAPTRIAL_BINARY_DIR "/libstand_in_lsl.so", "it has no entry");
  expect_plugin_refused(stand_in("_other_program"),
                        "was built for haptrial 0.0.1, of another time, and this is haptrial 0.");
  expect_plugin_refused(stand_in("_unlinked"), "nobody_has_this");
  expect_plugin_refused(stand_in("_bad_name"), "'two words'; allowed: letters");
}

TEST(PluginTest, ANameThatIsTakenIsRefused) {
  expect_plugin_refused(stand_in("_taken_device"), "there is a device 'mouse' already");
  expect_plugin_refused(stand_in("_bad_words"),
                        "'fields.NAME.calm: how calm it is' says nothing of a key; allowed: PATH");
  expect_plugin_refused(stand_in("_taken_field"), "there is a field 'spring' already");
  expect_line_refused("haptrial --plugin " + stand_in("") + " devices --plugin=" + stand_in(""),
                      "is the plug-in 'stand-in', which");
}

TEST(PluginTest, AFolderOfTheEnvironmentIsLoaded) {
  const test::TemporaryFolder folder;
  const std::string variable = "HAPTRIAL_PLUGINS='" + folder.path().string() + "' ";
  const std::string definition = calm_definition(folder);
  expect_line_refused(variable + "haptrial validate " + definition, "fields.quiet.type is 'calm'");
  std::filesystem::copy(stand_in(""), folder / "calm.so");
  const CommandResult with = run_command(variable + "haptrial validate " + definition);
  EXPECT_EQ(with.status, 0) << with.errors;
  expect_line_refused("HAPTRIAL_PLUGINS=/nowhere haptrial devices", "there is no folder /nowhere");
}

/// Parts that were run without a plug-in are not gone on with when one is loaded.
TEST(PluginTest, APartOfADryRunKeepsToItsPlugins) {
  const test::TemporaryFolder folder;
  const std::string rest = "dry-run " HAPTRIAL_SOURCE_DIR
                           "/experiments/first_experiment.toml --subjects 1 --trials 1 --parts '" +
                           (folder / "parts").string() + "'";
  const CommandResult ran = run_command("haptrial " + rest);
  ASSERT_EQ(ran.status, 0) << ran.errors;
  expect_line_refused("haptrial --plugin " + stand_in("") + " " + rest,
                      "holds sessions of another definition, script, seed or program");
}

/// A session keeps name, version and checksum; without the plug-in the sentence names it.
TEST(PluginTest, ASessionNamesThePluginThatItNeeds) {
  const test::TemporaryFolder folder;
  const std::string out = "'" + (folder / "sessions").string() + "'";
  const std::string with = "haptrial --plugin " + stand_in("") + " ";
  const CommandResult ran = run_command(with + "dry-run " + calm_definition(folder) +
                                        " --subjects 1 --trials 2 --out " + out);
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const CommandResult summed = run_command("sha256sum " + stand_in(""));
  const CommandResult kept = run_command("h5dump -d /events " + out + "/S01.h5");
  EXPECT_THAT(kept.output, HasSubstr("stand-in 1.0 " + summed.output.substr(0, 64)));
  EXPECT_THAT(kept.output, HasSubstr("field:calm"));
  for (const char* rest : {"analyze ", "replay --frames nowhere "}) {
    const std::string file = std::string(rest)[0] == 'r' ? "/S01.h5" : "";
    expect_line_refused(
        std::string("haptrial ") + rest + out + file,
        "was recorded with the plug-in stand-in 1.0, which has its field 'calm' and is "
        "not loaded; add --plugin FILE");
  }
  const CommandResult analysed = run_command(with + "analyze " + out);
  EXPECT_EQ(analysed.status, 0) << analysed.errors;
}

}  // namespace
}  // namespace haptrial
