# SPDX-License-Identifier: Apache-2.0
"""Two films of `shoal film` beside each other, as one animated WebP for a page.

usage: animate_films.py LEFT.mp4 TITLE RIGHT.mp4 TITLE OUT.webp

Every second picture at half size, without the film's own headline. Needs `av` and `pillow` from PyPI.
"""

import sys

import av
from PIL import Image, ImageDraw, ImageFont

SCALE, TOP, HEADLINE, GAP = 2, 26, 20, 10
BACKGROUND = (22, 22, 30)


def pictures(path):
    with av.open(path) as film:
        return [picture.to_image() for picture in film.decode(video=0)][::2], film.streams.video[0].average_rate


def beside(films, titles, font):
    """One picture of the animation."""
    width, height = films[0].width // SCALE, films[0].height // SCALE
    whole = Image.new("RGB", (2 * width + GAP, height + TOP - HEADLINE), BACKGROUND)
    draw = ImageDraw.Draw(whole)
    for i, (film, title) in enumerate(zip(films, titles)):
        left = i * (width + GAP)
        small = film.resize((width, height), Image.Resampling.BOX)
        whole.paste(small.crop((0, HEADLINE, width, height)), (left, TOP))
        draw.text((left + 8, 5), title, fill="white", font=font)
    return whole


def main():
    left, left_title, right, right_title, out = sys.argv[1:]
    (lefts, rate), (rights, _) = pictures(left), pictures(right)
    font = ImageFont.truetype("DejaVuSans-Bold.ttf", 15)
    frames = [beside(pair, (left_title, right_title), font) for pair in zip(lefts, rights)]
    frames[0].save(out, save_all=True, append_images=frames[1:], duration=round(2000 / rate), loop=0,
                   quality=60, method=4, minimize_size=True)


if __name__ == "__main__":
    main()
