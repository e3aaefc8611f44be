# SPDX-License-Identifier: Apache-2.0
"""The documentation stays short, and each sentence can be read once: words, sentences and lines of every page have limits."""
import pathlib
import re
import statistics

import pytest

ROOT = pathlib.Path(__file__).parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])

MOST_WORDS_OF_DOCS = 48_750  # 45,000, and room for a page on each of four new capabilities
MOST_WORDS_OF_A_SENTENCE = 25
MOST_WORDS_OF_THE_MEDIAN_SENTENCE = 15
MOST_CHARACTERS_OF_A_LINE = 120

ABBREVIATIONS = re.compile(r"\b(e\.g|i\.e|cf|vs|Fig|Eq|No|approx|et al)\.")
NO_PROSE = re.compile(r"#|\||<|!\[|\[[^\]]+\]: ")  # headings, tables, HTML, pictures, targets of links
SENTENCE_END = re.compile(r"(?<=[.!?])[)\"”*]*\s+(?=[\"“(*\[]*(?:[A-Z0-9]|kontur\b))")


def paragraphs(text):
    """(number of the first line, text) of each paragraph and list item."""
    block, start, fenced = [], 0, False
    for number, line in enumerate([*text.splitlines(), ""], 1):
        words = line.strip()
        if words.startswith("```"):
            fenced, words = not fenced, ""
        ends = fenced or not words or NO_PROSE.match(words)
        item = re.match(r"([-*+]|\d+\.)\s+(.*)", words)
        if (ends or item) and block:
            yield start, " ".join(block)
            block = []
        if not ends:
            start = start if block else number
            block.append(item[2] if item else words.lstrip("> "))


def spoken(text):
    """Markdown as it is read: a link by its words, code as one word."""
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)", "", text)
    text = re.sub(r"\[([^\]]*)\](\([^)]*\)|\[[^\]]*\])", r"\1", text)
    text = re.sub(r"`[^`]*`", "CODE", text).replace("**", "")
    return ABBREVIATIONS.sub(lambda match: match[1].replace(".", ""), text)


def sentences(text):
    """(number of the paragraph's first line, words, sentence) of each sentence."""
    for number, paragraph in paragraphs(text):
        for sentence in SENTENCE_END.split(spoken(paragraph)):
            if words := [word for word in sentence.split() if re.search(r"\w", word)]:
                yield number, len(words), sentence


def faults(name, text):
    """What is too long on a page, each with the page's name and the line."""
    found = list(sentences(text))
    for number, words, sentence in found:
        if words > MOST_WORDS_OF_A_SENTENCE:
            yield f"{name}:{number}: {words} words, at most {MOST_WORDS_OF_A_SENTENCE}: {sentence}"
    median = statistics.median([words for _, words, _ in found] or [0])
    if median > MOST_WORDS_OF_THE_MEDIAN_SENTENCE:
        yield f"{name}: the median sentence has {median} words, at most {MOST_WORDS_OF_THE_MEDIAN_SENTENCE}"
    for number, line in enumerate(text.splitlines(), 1):
        if len(line) > MOST_CHARACTERS_OF_A_LINE:
            yield f"{name}:{number}: {len(line)} characters, at most {MOST_CHARACTERS_OF_A_LINE}: {line}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_sentences_and_lines_are_short(page):
    found = list(faults(page.relative_to(ROOT).as_posix(), page.read_text(encoding="utf-8")))
    if found:
        pytest.fail("\n".join(found), pytrace=False)


def test_the_documentation_is_short():
    words = {page.relative_to(ROOT).as_posix(): len(page.read_text(encoding="utf-8").split()) for page in PAGES if ROOT / "docs" in page.parents}
    longest = sorted(words, key=words.get, reverse=True)[:5]
    assert sum(words.values()) <= MOST_WORDS_OF_DOCS, "the longest pages: " + ", ".join(f"{name} {words[name]}" for name in longest)


LONG = " ".join(["on"] * 26)


@pytest.mark.parametrize("text, fault", [
    (f"Short.\n\nA {LONG}.\n\nShort.", "page.md:3: 27 words, at most 25: A on on"),
    (f"- Short.\n- A {LONG}.\n- Short.", "page.md:2: 27 words"),
    ("A " + " ".join(["on"] * 15) + ".", "page.md: the median sentence has 16 words"),
    ("| a |\n|---|\n| " + "x" * 120 + " |", "page.md:3: 124 characters"),
])
def test_what_is_too_long_is_named(text, fault):
    assert [found[:len(fault)] for found in faults("page.md", text)] == [fault]


@pytest.mark.parametrize("text", [
    "One [link](that/is/long#and-not-read) counts its words. `code with many words` is one. kontur starts sentences.",
    f"```text\n{LONG}\n```",
    f"| {LONG} |",
    f"{LONG[:29]}\n\n- {LONG[:29]}\n- {LONG[:29]}",
])
def test_what_is_no_long_sentence_is_none(text):
    assert list(faults("page.md", text)) == []
