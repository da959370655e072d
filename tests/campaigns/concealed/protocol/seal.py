"""The seal on a campaign's truth: committed to by its hash, unreadable until every answer is in.

What is committed to is a text, truth.json: canonical JSON with 32 random bytes in it, so that
nobody finds the truth by hashing guesses. Sealed, it is XORed with a keystream of SHAKE-256 whose
key stands in this process's memory and nowhere else. That is a seal, not a safe: it keeps the truth
from being read in passing, and the hash keeps it from being changed. Opened, text and key are
written in clear, and anyone can check the first with `sha256sum -c seal.sha256`.
"""

import hashlib
import json
import secrets

NONCE_BYTES = KEY_BYTES = 32
SEALED, HASH, OPENED, KEY = "truth.sealed", "seal.sha256", "truth.json", "seal.key"


class Altered(Exception):
    """The sealed truth or its hash is not what was written."""


def canonical(thing):
    """The one way to write it: keys sorted, no spaces that carry nothing, ASCII."""
    return json.dumps(thing, sort_keys=True, indent=0, separators=(",", ":")).encode() + b"\n"


def mask(text, key):
    """XOR with the keystream of the key (bytes both); its own inverse."""
    stream = hashlib.shake_256(key).digest(len(text))
    return bytes(a ^ b for a, b in zip(text, stream))


def _hash_line(digest):
    return f"{digest}  {OPENED}\n"


class SealedTruth:
    """One campaign's truth between closing and opening."""

    def __init__(self, truth, folder):
        """Writes the truth (a dict), sealed, and its hash into the folder; keeps key and hash."""
        text = canonical({"nonce": secrets.token_hex(NONCE_BYTES), "truth": truth})
        self._key = secrets.token_bytes(KEY_BYTES)
        self._folder = folder
        self.sha256 = hashlib.sha256(text).hexdigest()
        self.path = folder / SEALED
        self.path.write_bytes(mask(text, self._key))
        (folder / HASH).write_text(_hash_line(self.sha256))

    def open(self):
        """The truth, written in clear beside the seal. Raises Altered."""
        try:
            text = mask(self.path.read_bytes(), self._key)
            written = (self._folder / HASH).read_text()
        except (OSError, ValueError) as error:
            raise Altered(f"the sealed truth was altered: {error}") from error
        if hashlib.sha256(text).hexdigest() != self.sha256:
            raise Altered("the sealed truth was altered")
        if written != _hash_line(self.sha256):
            raise Altered(f"the sealed truth was altered: {HASH} is not as written")
        (self._folder / OPENED).write_bytes(text)
        (self._folder / KEY).write_text(self._key.hex() + "\n")
        return json.loads(text)["truth"]
