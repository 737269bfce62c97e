#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/file_text.h"
#include "experiments/studio/studio.h"
#include "tests/experiments/command.h"
#include "tests/experiments/console_client.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::test {

inline std::string body_of(const std::string& answer) {
  return answer.substr(answer.find("\r\n\r\n") + 4);
}

/// A studio on a folder with the definition mine.toml, and a client of it.
class StudioTest : public testing::Test {
 protected:
  StudioTest() {
    const test::CommandResult made =
        run_command("cd '" + folder_.path().string() + "' && haptrial new mine.toml");
    EXPECT_EQ(made.status, 0) << made.errors;
    experiments::StudioOptions options;
    options.folder = folder_.path();
    options.program = HAPTRIAL_BINARY_DIR "/haptrial";
    options.libraries = libraries_.path();
    studio_ = std::make_unique<experiments::Studio>(options);
  }

  RawRequest reading(const std::string& path, const std::string& query = "") const {
    RawRequest request;
    request.method = "GET";
    request.host = "127.0.0.1:" + std::to_string(studio_->port());
    request.target = path + "?token=" + studio_->token() + (query.empty() ? "" : "&" + query);
    request.body.clear();
    return request;
  }
  RawRequest posting(const std::string& path, const nlohmann::json& body) const {
    RawRequest request;
    request.host = "127.0.0.1:" + std::to_string(studio_->port());
    request.target = path;
    request.token = studio_->token();
    request.body = body.dump();
    return request;
  }
  std::string exchange(const RawRequest& request) const {
    RawClient client(studio_->port());
    client.send(request.text());
    return client.receive(RawClient::kForever);
  }
  nlohmann::json got(const RawRequest& request) const {
    const std::string answer = exchange(request);
    EXPECT_EQ(status_of(answer), 200) << request.target << "\n" << answer;
    return nlohmann::json::parse(body_of(answer));
  }
  nlohmann::json get(const std::string& path, const std::string& query = "") const {
    return got(reading(path, query));
  }
  nlohmann::json post(const std::string& path, const nlohmann::json& body) const {
    return got(posting(path, body));
  }
  void expect_refused(const RawRequest& request, int status, const std::string& sentence) const {
    const std::uint64_t before = studio_->refused();
    const std::string answer = exchange(request);
    EXPECT_EQ(status_of(answer), status) << request.target << "\n" << answer;
    EXPECT_THAT(body_of(answer), testing::HasSubstr(sentence)) << request.target;
    EXPECT_EQ(studio_->refused(), before + 1) << request.target;
  }
  /// Waits until a job has ended. @returns it
  nlohmann::json ended(int number) const {
    for (;;) {
      const nlohmann::json job = get("/jobs")["jobs"].at(static_cast<std::size_t>(number) - 1);
      if (job["state"] != "running") {
        return job;
      }
      ::usleep(20'000);
    }
  }
  std::string text() const { return file_text(folder_ / "mine.toml"); }

  TemporaryFolder folder_;
  TemporaryFolder libraries_;
  std::unique_ptr<experiments::Studio> studio_;
};

}  // namespace haptrial::test
