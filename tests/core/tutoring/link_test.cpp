// Two sides that find each other by a secret, and what strangers can do.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "core/base/error.h"
#include "core/tutoring/handshake.h"
#include "core/tutoring/link_thread.h"
#include "core/tutoring/meeting.h"
#include "core/tutoring/sealer.h"
#include "core/tutoring/secret.h"
#include "core/tutoring/waiting_guests.h"
#include "tests/support/free_port.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace haptrial::tutoring::link_test {
namespace {

using testing::HasSubstr;
using namespace std::chrono_literals;

const Secret& secret() {
  static const Secret kept("a long enough secret", "test");
  return kept;
}

template <class Error, class Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(SecretTest, ComesFromAFileOfItsOwn) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "secret";
  std::ofstream(file) << "  a long enough secret\n";
  EXPECT_THAT(message_of<InputError>([&] { Secret::read(file); }), HasSubstr("chmod 600"));
  std::filesystem::permissions(file, std::filesystem::perms::owner_read);
  const Secret read = Secret::read(file);
  EXPECT_EQ(read.key({}), secret().key({}));
  EXPECT_NE(read.key({1}), secret().key({}));
  EXPECT_THAT(message_of<InputError>([&] { Secret("short", "here"); }),
              HasSubstr("here: the secret has 5 characters; allowed: 16 to 1024"));
  EXPECT_THROW(Secret::read(folder / "none"), InputError);
}

struct Both {
  LinkKeys host;
  LinkKeys guest;
};

Both shaken() {
  Handshake host(secret(), {7, {1}});
  Handshake guest(secret(), {9, {1}});
  const auto answer = guest.answer(host.opening());
  const auto closing = host.closing(*answer);
  EXPECT_TRUE(guest.finish(*closing));
  EXPECT_EQ(host.their_terms().port, 9);
  EXPECT_EQ(guest.their_terms().port, 7);
  return {host.keys(), guest.keys()};
}

TEST(HandshakeTest, BothHaveTheSameKeysCrosswiseAndNewOnesEachTime) {
  const Both first = shaken();
  EXPECT_EQ(first.host.send, first.guest.receive);
  EXPECT_EQ(first.host.receive, first.guest.send);
  EXPECT_NE(first.host.send, first.host.receive);
  EXPECT_EQ(first.host.session, first.guest.session);
  const Both second = shaken();
  EXPECT_NE(first.host.send, second.host.send);
  EXPECT_NE(first.host.session, second.host.session);
}

TEST(HandshakeTest, NoByteCanBeChangedOnTheWay) {
  Handshake host(secret(), {7, {1}});
  Handshake guest(secret(), {9, {1}});
  const Handshake::Answer answer = *guest.answer(host.opening());
  for (std::size_t i = 0; i < answer.size(); ++i) {
    Handshake::Answer changed = answer;
    changed[i] ^= 0x40;
    EXPECT_FALSE(host.closing(changed)) << "byte " << i;
  }
  const Handshake::Closing closing = *host.closing(answer);
  for (std::size_t i = 0; i < closing.size(); ++i) {
    Handshake::Closing changed = closing;
    changed[i] ^= 0x01;
    EXPECT_FALSE(guest.finish(changed)) << "byte " << i;
  }
  EXPECT_TRUE(guest.finish(closing));
  for (const std::size_t i : {0u, 20u, 40u, 63u}) {  // each costs a tenth of a second
    Handshake other(secret(), {9, {1}});
    Handshake::Opening changed = host.opening();
    changed[i] ^= 0x10;
    const auto wrong = other.answer(changed);
    EXPECT_FALSE(wrong && host.closing(*wrong)) << "byte " << i;
  }
}

TEST(HandshakeTest, AnotherSecretIsNotEnough) {
  const Secret wrong("another long secret", "test");
  Handshake host(secret(), {});
  Handshake guest(wrong, {});
  EXPECT_FALSE(host.closing(*guest.answer(host.opening())));
}

TickMessage message(std::uint64_t sequence) {
  TickMessage m;
  m.sequence = sequence;
  m.force = {1.0, 2.0, 3.0};
  return m;
}

TEST(SealerTest, OnlyWhatIsWholeNewAndOfThisSessionIsOpened) {
  const Both keys = shaken();
  const Sealer sealer(keys.host);
  Opener opener(keys.guest);
  const SealedBytes bytes = sealer.seal(message(5));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    SealedBytes changed = bytes;
    changed[i] ^= 0x80;
    EXPECT_FALSE(opener.open(changed)) << "byte " << i;
  }
  EXPECT_EQ(opener.counts().foreign, 8u) << "the session's number";
  EXPECT_EQ(opener.counts().forged, bytes.size() - 8);
  EXPECT_EQ(opener.open(bytes), message(5));
  EXPECT_FALSE(opener.open(bytes)) << "a recording of it";
  EXPECT_EQ(opener.counts().repeated, 1u);
  EXPECT_FALSE(opener.open(std::span(bytes).first(40)));
  Opener own(keys.host);
  EXPECT_FALSE(own.open(bytes)) << "sent back to its sender";
  EXPECT_FALSE(Opener(shaken().guest).open(bytes)) << "of an earlier session";
}

TEST(SealerTest, NothingOfTheMessageCanBeReadOff) {
  const Both keys = shaken();
  const SealedBytes first = Sealer(keys.host).seal(message(1));
  const SealedBytes second = Sealer(keys.host).seal(message(2));
  int same = 0;
  for (std::size_t i = 16; i < first.size(); ++i) {
    same += first[i] == second[i] ? 1 : 0;
  }
  EXPECT_LT(same, 8) << "of 200 bytes, by chance one or so";
}

struct Pair {
  EstablishedLink host;
  EstablishedLink guest;
};

MeetingRequest as_host(std::uint16_t port) {
  MeetingRequest request;
  request.port = port;
  request.patience = 1h;
  return request;
}

MeetingRequest as_guest(std::uint16_t port, const std::string& name = "127.0.0.1") {
  MeetingRequest request = as_host(port);
  request.guest_of = name + ":" + std::to_string(port);
  return request;
}

/// The host may not listen yet.
template <class Call>
auto soon(Call call) -> decltype(call()) {
  for (;;) {
    try {
      return call();
    } catch (const RunError& error) {
      if (std::string(error.what()).find("cannot be reached") == std::string::npos) {
        throw;
      }
      std::this_thread::sleep_for(50ms);
    }
  }
}

Pair met() {
  const std::uint16_t port = test::free_port();
  std::optional<EstablishedLink> host;
  std::thread waiting([&] { host = meet(secret(), as_host(port)); });
  EstablishedLink guest = soon([&] { return meet(secret(), as_guest(port)); });
  waiting.join();
  return {std::move(*host), std::move(guest)};
}

TEST(MeetingTest, AGuestWithoutTheSecretIsTurnedAwayAndTheNextLetIn) {
  const std::uint16_t port = test::free_port();
  std::vector<std::string> notices;
  std::optional<EstablishedLink> host;
  std::thread waiting([&] {
    MeetingRequest request = as_host(port);
    request.notice = [&](const std::string& text) { notices.push_back(text); };
    host = meet(secret(), request);
  });
  const Secret wrong("another long secret", "test");
  EXPECT_THAT(message_of<RunError>([&] { soon([&] { return meet(wrong, as_guest(port)); }); }),
              HasSubstr("the secrets differ"));
  const EstablishedLink guest = meet(secret(), as_guest(port, "localhost"));
  waiting.join();
  ASSERT_TRUE(host.has_value());
  EXPECT_EQ(host->keys.send, guest.keys.receive);
  EXPECT_THAT(notices, testing::ElementsAre(HasSubstr("without the secret")));
}

/// A connection that says nothing; waits until the host has spoken to it.
Socket silent_guest(std::uint16_t port) {
  Socket socket = soon([&] {
    return connected(address_of("127.0.0.1:" + std::to_string(port)),
                     {std::chrono::steady_clock::now() + 20s, {}});
  });
  Handshake::Opening opening;
  EXPECT_TRUE(receive_all(socket, opening, {std::chrono::steady_clock::now() + 60s, {}}));
  return socket;
}

TEST(MeetingTest, SilentGuestsHoldUpNobody) {
  const std::uint16_t port = test::free_port();
  std::optional<EstablishedLink> host;
  std::thread waiting([&] { host = meet(secret(), as_host(port)); });
  std::vector<Socket> silent;
  for (int i = 0; i < 4; ++i) {
    silent.push_back(silent_guest(port));
  }
  const EstablishedLink guest = meet(secret(), as_guest(port));
  waiting.join();
  EXPECT_EQ(host->keys.send, guest.keys.receive);
  for (const Socket& left : silent) {
    Handshake::Closing closing;
    ASSERT_TRUE(receive_all(left, closing, {std::chrono::steady_clock::now() + 60s, {}}));
    EXPECT_TRUE(Handshake::is_busy(closing));
  }
}

TEST(MeetingTest, OfTooManyTheOneThatHasWaitedLongestIsToldThatTheHostIsBusy) {
  const std::uint16_t port = test::free_port();
  std::optional<EstablishedLink> host;
  std::thread waiting([&] { host = meet(secret(), as_host(port)); });
  bool told = false;
  while (!told) {  // on a busy machine some leave before the last has come
    std::vector<Socket> silent;
    for (std::size_t i = 0; i <= WaitingGuests::kMost; ++i) {
      silent.push_back(silent_guest(port));
    }
    Handshake::Closing closing;
    told = receive_all(silent.front(), closing, {std::chrono::steady_clock::now() + 60s, {}}) &&
           Handshake::is_busy(closing);
  }
  const EstablishedLink guest = meet(secret(), as_guest(port));
  waiting.join();
  EXPECT_EQ(host->keys.send, guest.keys.receive);
}

TEST(MeetingTest, AGuestThatIsToldSoSaysThatTheHostIsBusy) {
  for (const bool at_once : {true, false}) {
    const std::uint16_t port = test::free_port();
    const Socket listener = listening(port);
    std::string said;
    std::thread guest(
        [&] { said = message_of<RunError>([&] { meet(secret(), as_guest(port)); }); });
    const Patience patience{std::chrono::steady_clock::now() + 60s, {}};
    Address from;
    const Socket socket = accepted(listener, patience, &from);
    if (at_once) {
      EXPECT_TRUE(send_all(socket, Handshake::busy<Handshake::Opening>(), patience));
    } else {
      const Handshake host(secret(), {port, {}});
      Handshake::Answer answer;
      EXPECT_TRUE(send_all(socket, host.opening(), patience));
      EXPECT_TRUE(receive_all(socket, answer, patience));
      EXPECT_TRUE(send_all(socket, Handshake::busy<Handshake::Closing>(), patience));
    }
    guest.join();
    EXPECT_THAT(said, HasSubstr("busy with other guests; try again"));
  }
}

TEST(MeetingTest, AnotherStudyIsRefusedOnBothSides) {
  const std::uint16_t port = test::free_port();
  std::string told;
  std::thread waiting([&] {
    MeetingRequest request = as_host(port);
    request.shared = {{"definition", "a"}, {"subject", "P01"}, {"seed", "1"}};
    told = message_of<InputError>([&] { meet(secret(), request); });
  });
  MeetingRequest request = as_guest(port);
  request.shared = {{"definition", "b"}, {"subject", "P01"}, {"seed", "2"}};
  EXPECT_THAT(message_of<InputError>([&] { soon([&] { return meet(secret(), request); }); }),
              HasSubstr("another definition, seed; both"));
  waiting.join();
  EXPECT_THAT(told, HasSubstr("another definition, seed; both"));
}

TEST(MeetingTest, WhatCannotBeIsSaid) {
  MeetingRequest request = as_host(test::free_port());
  request.patience = 0s;
  EXPECT_THAT(message_of<RunError>([&] { meet(secret(), request); }), HasSubstr("nobody came"));
  EXPECT_THAT(message_of<RunError>([&] { meet(secret(), as_guest(test::free_port())); }),
              HasSubstr("cannot be reached"));
  for (const char* address : {"host", "host:", ":7400", "host:0", "host:70000", "host:7x"}) {
    request.guest_of = address;
    EXPECT_THAT(message_of<InputError>([&] { meet(secret(), request); }),
                HasSubstr("allowed: NAME:PORT"))
        << address;
  }
}

TEST(LinkThreadTest, EverythingArrivesAndAFloodOfStrangersIsCounted) {
  Pair pair = met();
  const std::uint16_t port = port_of(pair.guest.datagrams);
  const LinkKeys own = pair.host.keys;
  LinkThread host(std::move(pair.host));
  LinkThread guest(std::move(pair.guest));
  guest.tick();  // what comes before is counted, and not heard
  std::atomic<bool> over{false};
  std::atomic<std::uint64_t> thrown{0};
  std::thread stranger([&] {
    const Socket socket = datagram_socket(0);
    Address to = address_of("127.0.0.1:" + std::to_string(port));
    const SealedBytes replay = Sealer(own).seal(message(1));
    const SealedBytes noise(replay.size());
    LinkKeys guessed = own;
    guessed.send[0] ^= 1;
    std::uint64_t rounds = 0;
    while (!over.load()) {
      const SealedBytes forged = Sealer(guessed).seal(message(1'000'000 + thrown));
      for (const SealedBytes* bytes : {&noise, &replay, &forged}) {
        thrown += ::sendto(socket.get(), bytes->data(), bytes->size(), 0,
                           reinterpret_cast<const sockaddr*>(&to.storage), to.size) > 0;
      }
      if (++rounds % 10 == 0) {
        std::this_thread::sleep_for(200us);
      }
    }
  });
  constexpr std::uint64_t kMessages = 1000;
  std::vector<std::uint64_t> came;
  struct MessageTaker final : Listener {
    std::vector<std::uint64_t>* came;
    void hear(const Arrived& a) noexcept override { came->push_back(a.message.sequence); }
  };
  MessageTaker taker;
  taker.came = &came;
  const auto take = [&] { guest.receive(taker); };
  for (std::uint64_t i = 1; i <= kMessages; ++i) {
    TickMessage m = message(i);
    m.sent_ns = link_clock_ns();
    host.send(m);
    take();
    std::this_thread::sleep_for(1ms);
  }
  over = true;
  stranger.join();
  WireCounts counts;
  std::this_thread::sleep_for(200ms);
  test::wait_until([&] {  // a busy machine may still have some of it on its way
    counts = guest.counts();
    take();
    return counts.accepted == came.size();
  });
  EXPECT_EQ(host.counts().sent, kMessages);
  EXPECT_LE(came.size(), kMessages);
  EXPECT_GT(came.size(), kMessages / 10) << "on a busy machine the system's queue loses some";
  EXPECT_TRUE(std::adjacent_find(came.begin(), came.end(), std::greater_equal<>()) == came.end());
  EXPECT_GT(counts.foreign, 100u);
  EXPECT_GT(counts.forged, 100u);
  EXPECT_GT(counts.repeated, 100u);
}

}  // namespace
}  // namespace haptrial::tutoring::link_test
