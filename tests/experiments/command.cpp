#include "tests/experiments/command.h"

#include <sys/wait.h>

#include <cstdlib>

#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::test {

CommandResult run_command(const std::string& line) {
  const TemporaryFolder folder;
  const std::string script =
      "HAPTRIAL='" HAPTRIAL_BINARY_DIR "/haptrial'\nhaptrial() { \"$HAPTRIAL\" \"$@\"; }\n" + line;
  write_text(folder / "script", script);
  const std::string shell = "bash '" + (folder / "script").string() + "' >'" +
                            (folder / "output").string() + "' 2>'" + (folder / "errors").string() +
                            "' </dev/null";
  const int status = std::system(shell.c_str());
  CommandResult result;
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.output = read_text(folder / "output");
  result.errors = read_text(folder / "errors");
  return result;
}

}  // namespace haptrial::test
