// The wire types: what a message is on the wire must not change unnoticed, and no payload may hurt a receiver.
#include <gtest/gtest.h>

#include "proto/codec.h"
#include "tests/contract/samples.h"

namespace shaken::proto {
namespace {

/// Fingerprints as lcm-gen made them when the types were agreed. A change here is a change of the protocol: old
/// recordings and old viewers no longer understand the type.
template <class T>
constexpr std::uint64_t kFingerprint = 0;
template <>
constexpr std::uint64_t kFingerprint<status_t> = 0x9f11dbe701d4d3d3;
template <>
constexpr std::uint64_t kFingerprint<job_t> = 0x1de0a0e67079db2f;
template <>
constexpr std::uint64_t kFingerprint<observables_t> = 0x59b43e22b4b3c113;
template <>
constexpr std::uint64_t kFingerprint<frame_static_t> = 0x64ae93f12db25394;
template <>
constexpr std::uint64_t kFingerprint<frame_t> = 0x0d06d91756eff7d0;
template <>
constexpr std::uint64_t kFingerprint<defects_t> = 0xeddba365494e32b5;

template <class T>
class WireType : public testing::Test {};
template <>
constexpr std::uint64_t kFingerprint<posts_t> = 0xee2ebc06ec3e5b90;
template <>
constexpr std::uint64_t kFingerprint<sizes_t> = 0xd7bf43e2e931e56c;

using AllTypes = testing::Types<status_t, job_t, observables_t, frame_static_t, frame_t, defects_t, posts_t, sizes_t>;
TYPED_TEST_SUITE(WireType, AllTypes);

TYPED_TEST(WireType, KeepsItsFingerprint) {
  EXPECT_EQ(static_cast<std::uint64_t>(TypeParam::getHash()), kFingerprint<TypeParam>)
      << std::hex << static_cast<std::uint64_t>(TypeParam::getHash());
}

TYPED_TEST(WireType, ComesBackAsItWasSent) {
  const auto payload = encode(samples::make<TypeParam>());
  const auto decoded = decode<TypeParam>(payload);
  ASSERT_TRUE(decoded);
  EXPECT_EQ(encode(*decoded), payload);
  EXPECT_EQ(decoded->sequence, samples::make<TypeParam>().sequence);
}

TYPED_TEST(WireType, PlainLcmDecoderAgrees) {
  const auto payload = encode(samples::make<TypeParam>());
  TypeParam plain;
  ASSERT_EQ(plain.decode(payload.data(), 0, static_cast<int>(payload.size())), static_cast<int>(payload.size()));
  EXPECT_EQ(encode(plain), payload);
}

TYPED_TEST(WireType, BeginsWithFingerprintAndTime) {
  const auto payload = encode(samples::make<TypeParam>());
  std::int64_t utime = 0;
  for (std::size_t i = 8; i < 16; ++i) utime = utime << 8 | payload[i];
  EXPECT_EQ(utime, samples::kTime);
}

TYPED_TEST(WireType, RefusesEveryTruncation) {
  const auto payload = encode(samples::make<TypeParam>());
  for (std::size_t size = 0; size < payload.size(); ++size) {
    // A copy of exactly that size, so that a sanitizer sees any read past its end.
    const std::vector<std::uint8_t> cut(payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(decode<TypeParam>(cut)) << size << " of " << payload.size() << " bytes";
  }
}

TYPED_TEST(WireType, RefusesOverLongPayloads) {
  auto payload = encode(samples::make<TypeParam>());
  payload.push_back(0);
  EXPECT_FALSE(decode<TypeParam>(payload));
}

TYPED_TEST(WireType, RefusesAnotherTypesFingerprint) {
  auto payload = encode(samples::make<TypeParam>());
  payload[3] ^= 0x10;
  EXPECT_FALSE(decode<TypeParam>(payload));
}

/// Any four bytes may be a length to somebody: huge, negative and overflowing ones must be refused or harmless.
TYPED_TEST(WireType, SurvivesHostileLengthsAtEveryOffset) {
  const auto payload = encode(samples::make<TypeParam>());
  for (const std::uint32_t value : {0U, 0x7fffffffU, 0x80000000U, 0xffffffffU, 0x40000000U, 0x20000000U, 0x10000U}) {
    for (std::size_t at = 0; at + 4 <= payload.size(); ++at) {
      auto hostile = payload;
      for (std::size_t i = 0; i < 4; ++i) hostile[at + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
      const auto decoded = decode<TypeParam>(hostile);
      if (decoded) {
        EXPECT_EQ(encode(*decoded), hostile);
      }
    }
  }
}

TEST(MessageSize, CountsWhatTheLayoutSays) {
  // Fingerprint, string "ab" and NUL, count 2, two numbers of 2 bytes.
  const std::vector<std::uint8_t> payload{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 'a', 'b', 0, 0, 0, 0, 2, 1, 2, 3, 4};
  EXPECT_EQ(message_size("snH", payload), payload.size());
  EXPECT_EQ(message_size("sn", payload), payload.size() - 4);
  EXPECT_EQ(message_size("snHH", payload), std::nullopt);
}

TEST(MessageSize, ArraysGoByTheLastCount) {
  // Fingerprint, count 2, two numbers of 4 bytes, count 3, three bytes.
  const std::vector<std::uint8_t> payload{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 1, 2,
                                          3, 4, 5, 6, 7, 8, 0, 0, 0, 3, 1, 2, 3};
  EXPECT_EQ(message_size("nW nB", payload), payload.size());
  EXPECT_EQ(message_size("nW n", payload), payload.size() - 3);
  EXPECT_EQ(message_size("nW nBB", payload), std::nullopt);
}

TEST(MessageSize, StringsMustEndInTheirFirstNul) {
  const std::vector<std::uint8_t> open_end{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 'a', 'b'};
  EXPECT_EQ(message_size("s", open_end), std::nullopt);
  const std::vector<std::uint8_t> empty{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(message_size("s", empty), std::nullopt);
  // what follows would be lost by whoever reads it as text
  const std::vector<std::uint8_t> hidden{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 'a', 0, 'b', 0};
  EXPECT_EQ(message_size("s", hidden), std::nullopt);
  const std::vector<std::uint8_t> no_letters{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0};
  EXPECT_EQ(message_size("s", no_letters), no_letters.size());
}

}  // namespace
}  // namespace shaken::proto
