"""Challenges on the page: the list, a tick once reached, and links to hand in that are judged anew."""

from __future__ import annotations

import pytest

from stridula.app.challenges import CHALLENGES

from .browsing import Browsing, until

FRICTION = "contact.friction.coefficient"
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True}
NAME = "largest-friction"
VERDICT = "document.getElementById('challenge-verdict').textContent"
LINK = f"#case=judder&{FRICTION}={{}}&challenge={NAME}"


def slide(page, value: float) -> None:
    field = page.locator(f"input[type=number][data-key='{FRICTION}']")
    field.fill(str(value))
    field.press("Enter")


def ticks(page) -> list[str]:
    return [one.text_content() for one in page.locator("#challenge-cards .tick").all()]


def test_a_challenge_is_taken_and_reached_by_keys_and_stays_ticked(browsing):
    page = browsing.open("#case=squeal")
    assert page.locator("#challenge").is_hidden()
    page.locator("#challenges-open").focus()
    page.keyboard.press("Enter")
    assert page.locator("#challenge-cards button").count() == len(CHALLENGES)
    assert page.locator("#challenge-count").text_content() == f"0 of {len(CHALLENGES)} reached"
    number = list(CHALLENGES).index(NAME)
    for _ in range(number):
        page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    one = CHALLENGES[NAME]
    assert page.locator("#challenges").is_hidden()
    assert page.locator("#challenge-title").text_content() == one.title
    assert page.locator("#challenge-words").text_content() == one.words
    assert page.locator("#challenge-where").text_content() == f"Challenge {number + 1} of {len(CHALLENGES)}"
    until(page, "stridula.now().title === 'Judder'")
    # The case has not reached it, whatever the headline names first.
    until(page, f"{VERDICT}.startsWith('It ')")
    assert page.locator("#challenge-hint").is_hidden()
    page.locator("#challenge summary").click()
    assert page.locator("#challenge-hint").text_content() == one.hint
    slide(page, 0.99)
    until(page, f"{VERDICT} === '✓ Reached.'")
    assert "held 3.0 of 3 s" in page.locator("#challenge-time").text_content()
    page.locator("#challenge-all").click()
    assert [tick == "✓ reached" for tick in ticks(page)] == [one == NAME for one in CHALLENGES]
    page.keyboard.press("Escape")
    page.locator("#challenge-leave").click()
    assert page.locator("#challenge").is_hidden()
    assert page.evaluate("document.activeElement.id") == "challenges-open"
    until(page, "!location.hash.includes('challenge')")
    page.reload()
    page.locator("#challenges-open").click()
    until(page, "document.querySelectorAll('#challenge-cards .tick').length > 0")
    assert ticks(page).count("✓ reached") == 1
    page.locator("#challenge-forget").click()
    assert ticks(page).count("✓ reached") == 0


def test_the_link_to_hand_in_carries_the_setting_and_is_judged_anew(chromium, server):
    context = {"permissions": ["clipboard-read", "clipboard-write"]}
    with Browsing(chromium, server, **context) as browsing:
        page = browsing.open(f"#challenge={NAME}")
        # A challenge without a setting begins with its case.
        until(page, "stridula.now().title === 'Judder'")
        slide(page, 0.985)
        until(page, f"{VERDICT} === '✓ Reached.'")
        page.locator("#challenge-link").click()
        until(page, "document.getElementById('said').textContent === 'link copied'")
        link = page.evaluate("navigator.clipboard.readText()")
        page.close()
        assert link.endswith(LINK.format("0.985"))
    with Browsing(chromium, server) as browsing:
        page = browsing.open(link.removeprefix(server.address))
        assert page.locator("#challenge-title").text_content() == CHALLENGES[NAME].title
        assert page.evaluate(VERDICT).startswith("Judging")
        until(page, f"{VERDICT} === '✓ The setting of this link meets the challenge.'")
        # The tick is for the one who did it.
        assert ticks(page).count("✓ reached") == 0


@pytest.mark.parametrize(
    ("value", "verdict"),
    [
        ("1.1", "The setting of this link does not meet the challenge. It judders."),
        ("0.8", "The setting of this link does not meet the challenge. It also slides at a larger friction."),
        ("-3", "The setting of this link cannot be played as a whole, so it is not judged."),
    ],
)
def test_a_link_that_claims_too_much_is_found_out(browsing, value, verdict):
    page = browsing.open(LINK.format(value))
    until(page, f"{VERDICT} === arg", verdict)
    assert page.locator("#challenge.reached").count() == 0
    # Another value is the visitor's own.
    slide(page, 0.99)
    until(page, f"{VERDICT} === '✓ Reached.'")
    assert ticks(page).count("✓ reached") == 1


def test_an_unknown_challenge_is_named(browsing):
    page = browsing.open("#case=squeal&challenge=nonsense")
    until(page, "document.getElementById('problem').textContent.includes('nonsense')")
    assert page.locator("#challenge").is_hidden()


def test_tour_and_challenge_take_the_place_of_each_other(browsing):
    page = browsing.open(f"#challenge={NAME}")
    page.locator("#tour-begin").click()
    assert page.locator("#challenge").is_hidden()
    assert page.locator("#tour").is_visible()
    page.locator("#challenges-open").click()
    page.locator("#challenge-cards button").first.click()
    assert page.locator("#tour").is_hidden()
    assert page.locator("#challenge").is_visible()


def test_a_phone_has_the_challenge_above_the_pictures(chromium, server):
    with Browsing(chromium, server, **PHONE) as browsing:
        page = browsing.open(f"#challenge={NAME}")
        box = page.locator("#challenge").bounding_box()
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= 390
        small = page.evaluate(
            """[...document.querySelectorAll('#challenge button, #challenge summary')]
              .map((one) => one.getBoundingClientRect().height).filter((height) => height < 43.5)"""
        )
        assert small == []
        assert page.evaluate("document.documentElement.scrollWidth") <= 390


def test_storage_with_nonsense_counts_as_no_ticks(browsing):
    browsing.context.add_init_script("localStorage.setItem('challenges reached', '{nonsense')")
    page = browsing.open("#case=squeal")
    assert ticks(page).count("✓ reached") == 0
