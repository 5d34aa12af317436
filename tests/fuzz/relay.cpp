// The bytes of one client of the relay: what it publishes must be what it sent, and every instruction has one form.
#include <fcntl.h>
#include <sys/socket.h>

#include "base/descriptor.h"
#include "proto/relay/client.h"
#include "tests/fuzz/fuzz_target.h"

using namespace shaken;

namespace {

/// Instruction by instruction.
void parse(std::string_view bytes, const relay::Limits& limits) {
  for (;;) {
    const relay::Parsed parsed = relay::parse_instruction(bytes, limits);
    if (const auto* unreadable = std::get_if<relay::Unreadable>(&parsed)) {
      fuzz::promise(!unreadable->reason.empty(), "a refusal says why");
    }
    const auto* instruction = std::get_if<relay::Instruction>(&parsed);
    if (instruction == nullptr) return;
    const bool publishes = instruction->kind == relay::Kind::kPublish;
    const std::string again = publishes ? relay::publication(instruction->text, instruction->payload)
                                        : relay::subscription(instruction->kind, instruction->text);
    fuzz::promise(again == bytes.substr(0, instruction->size), "what is taken is written as the same bytes");
    bytes.remove_prefix(instruction->size);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const relay::Limits limits;
  const std::string_view bytes = fuzz::text_of(data, size);
  parse(bytes, limits);
  int ends[2];
  fuzz::promise(socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends) == 0, "there are sockets");
  Descriptor other(ends[1]);
  const auto now = relay::Client::Clock::now();
  relay::Client client(Descriptor{ends[0]}, limits, now);
  std::string sent = relay::client_greeting();
  sent.append(bytes);
  (void)send(other.value(), sent.data(), sent.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  other.close_now();
  while (!client.has_ended()) {
    client.receive(
        [&](std::string_view channel, std::string_view payload) {
          fuzz::promise(bytes.find(channel) != std::string_view::npos && bytes.find(payload) != std::string_view::npos,
                        "what is published was sent");
          (void)client.wants(channel);
        },
        now);
  }
  return 0;
}
