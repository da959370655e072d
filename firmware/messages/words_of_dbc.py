"""Writes how the frames of a DBC file are packed by 32-bit words: cantools' own code goes byte by byte.

words_of_dbc.py flexcomp.dbc flexcomp_can_words.hpp

For each frame a specialisation of Words over the struct that cantools generates for it. Takes what flexcomp.dbc
has: little-endian signals, frames of whole words."""

import re
import sys

MESSAGE = re.compile(r"^BO_ (\d+) (\w+): (\d+) ")
SIGNAL = re.compile(r"^ SG_ (\w+) : (\d+)\|(\d+)@1([+-]) ")
FLOAT = re.compile(r"^SIG_VALTYPE_ (\d+) (\w+) ?: ?1 ?;")

HEAD = """#pragma once

// Generated from flexcomp.dbc. NOLINTBEGIN

#include <cstdint>
#include <cstring>

#include "flexcomp_can.h"

namespace flexcomp::can {

/// A frame as 32-bit words, the first byte lowest.
template <typename Raw>
struct Words;
"""


def snake_case(name):
    """As cantools names its structs."""
    name = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", name)
    return re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", name).lower()


class Signal:
    def __init__(self, name, start, bits, is_signed):
        self.name, self.start, self.bits, self.is_signed = name, start, bits, is_signed
        self.is_float = False

    def pieces(self):
        """(word, place in it, place in the signal, bits) of each word that holds a part of it."""
        at = self.start
        while at < self.start + self.bits:
            end = min(self.start + self.bits, (at // 32 + 1) * 32)
            yield at // 32, at % 32, at - self.start, end - at
            at = end

    def value(self):
        """The signal's number, of at least 32 bits, from the struct."""
        if self.is_float:
            return f"bits_of(raw.{self.name})"
        return f"static_cast<std::uint{64 if self.bits > 32 else 32}_t>(raw.{self.name})"

    def read(self):
        """Statement that sets it in the struct."""
        wide = 64 if self.bits > 32 else 32
        parts = []
        for word, place, within, bits in self.pieces():
            part = f"words[{word}]" + (f" >> {place}" if place else "")
            if place + bits < 32:
                part = f"({part} & {hex((1 << bits) - 1)}U)"
            elif place:
                part = f"({part})"
            if wide == 64:
                part = f"std::uint64_t{{{part}}}"
            parts.append(part + (f" << {within}" if within else ""))
        number = " | ".join(f"({part})" if len(parts) > 1 else part for part in parts)
        if self.is_float:
            return f"raw->{self.name} = float_of({number});"
        if self.is_signed:
            number = f"sign_extended<{self.bits}>({number})"
        return f"raw->{self.name} = static_cast<decltype(raw->{self.name})>({number});"


def parsed(lines):
    """Frame's identifier to its name, bytes and signals."""
    frames = {}
    for line in lines:
        if found := MESSAGE.match(line):
            signals = []
            frames[found[1]] = (found[2], int(found[3]), signals)
        elif found := SIGNAL.match(line):
            signals.append(Signal(found[1], int(found[2]), int(found[3]), found[4] == "-"))
        elif line.startswith(" SG_"):
            sys.exit(f"{sys.argv[1]}: expected a little-endian signal that is not multiplexed: {line.strip()}")
        elif found := FLOAT.match(line):
            for signal in frames[found[1]][2]:
                signal.is_float |= signal.name == found[2]
    return frames


def packed(signals, words):
    """Statements that set the words from the struct."""
    parts = [[] for _ in range(words)]
    for signal in signals:
        for word, place, within, bits in signal.pieces():
            part = signal.value() + (f" >> {within}" if within else "")
            if bits < 32 and place + bits < 32:
                part = f"({part} & {hex((1 << bits) - 1)}U)"
            elif within:
                part = f"({part})"
            if signal.bits > 32:
                part = f"static_cast<std::uint32_t>({part})"
            parts[word].append(part + (f" << {place}" if place else ""))
    return [f"words[{word}] = " + (" | ".join(f"({part})" for part in of) or "0") + ";"
            for word, of in enumerate(parts)]


def specialisation(name, size, signals):
    if size % 4 != 0:
        sys.exit(f"{sys.argv[1]}: {name}: expected a frame of whole words, found {size} bytes")
    struct = f"flexcomp_can_{snake_case(name)}_t"
    body = "\n".join("    " + line for line in packed(signals, size // 4))
    back = "\n".join("    " + signal.read() for signal in signals)
    return f"""
template <>
struct Words<{struct}> {{
  static void pack(const {struct}& raw, std::uint32_t* words) {{
{body}
  }}
  static void unpack(const std::uint32_t* words, {struct}* raw) {{
{back}
  }}
}};
"""


HELPERS = """
inline std::uint32_t bits_of(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

inline float float_of(std::uint32_t bits) {
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

template <int Bits>
std::int32_t sign_extended(std::uint32_t value) {
  return static_cast<std::int32_t>(value << (32 - Bits)) >> (32 - Bits);
}
"""


def main():
    with open(sys.argv[1], encoding="utf-8") as source:
        frames = parsed(source)
    with open(sys.argv[2], "w", encoding="utf-8") as target:
        target.write(HEAD + HELPERS)
        for name, size, signals in frames.values():
            target.write(specialisation(name, size, signals))
        target.write("\n}  // namespace flexcomp::can\n// NOLINTEND\n")


if __name__ == "__main__":
    main()
