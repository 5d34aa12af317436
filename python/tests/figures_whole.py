"""Whether a figure is cut at its border."""
from typing import Any

import numpy as np


def assert_whole(sheet: Any) -> None:
    """Everything is inside the figure, by matplotlib's own measures and by the pixels at its border."""
    sheet.finish()
    canvas = sheet.figure.canvas
    whole = sheet.figure.get_tightbbox(canvas.get_renderer())
    assert whole.x0 >= 0 and whole.y0 >= 0
    assert whole.x1 <= sheet.width + 1e-6 and whole.y1 <= sheet.height + 1e-6
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())[..., :3]
    for border in (pixels[:2], pixels[-2:], pixels[:, :2], pixels[:, -2:]):
        assert np.all(border == 255)
