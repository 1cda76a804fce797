"""An L-system and its plant, side by side in the browser: `bioscope edit`.

`document` is the file that is edited, `growing` makes plants of texts, `worker` does so in a
process of its own, `workshop` looks after these processes, `server` is what pages talk to, in
`messages`.
"""

from bioscope.lsystem.editor.server import edit

__all__ = ["edit"]
