/// Copying and filling memory by words: newlib-nano's own go byte by byte.
#include <cstddef>
#include <cstdint>

namespace {

constexpr std::size_t kWord = sizeof(std::uint32_t);

struct Words4 {
  std::uint32_t word[4];
};

/// Where it lies at no multiple of its size: the processor loads and stores words anywhere, but
/// only one at a time.
struct [[gnu::packed]] WordAnywhere {
  std::uint32_t word;
};

bool are_aligned(const void* a, const void* b) {
  return ((reinterpret_cast<std::uintptr_t>(a) | reinterpret_cast<std::uintptr_t>(b)) % kWord) == 0;
}

}  // namespace

extern "C" {

// Or the compiler finds that these loops are memcpy and memset, and calls them.
#pragma GCC optimize("no-tree-loop-distribute-patterns")

[[gnu::used]] void* memcpy(void* __restrict to, const void* __restrict from, std::size_t size) {
  auto* end = static_cast<unsigned char*>(to);
  const auto* next = static_cast<const unsigned char*>(from);
  if (are_aligned(to, from)) {
    for (; size >= sizeof(Words4); size -= sizeof(Words4)) {
      *reinterpret_cast<Words4*>(end) = *reinterpret_cast<const Words4*>(next);
      end += sizeof(Words4);
      next += sizeof(Words4);
    }
  }
  for (; size >= kWord; size -= kWord) {
    *reinterpret_cast<WordAnywhere*>(end) = *reinterpret_cast<const WordAnywhere*>(next);
    end += kWord;
    next += kWord;
  }
  for (; size > 0; --size) {
    *end++ = *next++;
  }
  return to;
}

[[gnu::used]] void* memset(void* to, int value, std::size_t size) {
  auto* end = static_cast<unsigned char*>(to);
  const auto byte = static_cast<unsigned char>(value);
  if (are_aligned(to, to)) {
    const std::uint32_t word = 0x01010101U * byte;
    const Words4 words{{word, word, word, word}};
    for (; size >= sizeof(Words4); size -= sizeof(Words4)) {
      *reinterpret_cast<Words4*>(end) = words;
      end += sizeof(Words4);
    }
    for (; size >= kWord; size -= kWord) {
      *reinterpret_cast<std::uint32_t*>(end) = word;
      end += kWord;
    }
  }
  for (; size > 0; --size) {
    *end++ = byte;
  }
  return to;
}

}  // extern "C"
