"""Machines with physics that no catalogue holds, alone, beside a catalogue effect, or not at all.

`law` says what such physics is, `drives`, `places`, `sensors` and `unseen` hold it, `menu` draws it,
`cases` writes recordings, `trial` has them diagnosed, `judge` measures. Nothing here knows how flexcomp
searches: the plant is MuJoCo's, and a law is told to flexcomp only where its truth is checked.
"""
