// The cases as pictures that one knows: one group of cards, of which one is played.
import { draw, sketchOf } from "./sketches.js";

export class Gallery {
  constructor(presets, choose) {
    const [dialog, cards] = [document.getElementById("gallery"), document.getElementById("cards")];
    this.cards = new Map(presets.map((one) => [one.name, card(one)]));
    cards.replaceChildren(...this.cards.values());
    // With keys one goes through the cards and hears each; a card that is pressed is the one wanted.
    cards.addEventListener("change", ({ target }) => choose(target.value));
    cards.addEventListener("click", (event) => event.detail && event.target.matches("input") && dialog.close());
    cards.addEventListener("keydown", (event) => {
      if (event.key !== "Enter") return;
      event.preventDefault();
      dialog.close();
    });
    document.getElementById("instruments").addEventListener("click", () => {
      dialog.showModal();
      (cards.querySelector(":checked") ?? cards.querySelector("input")).focus();
    });
  }

  // Show which is played, none of one's own.
  show(name) {
    draw(document.getElementById("instrument"), name);
    for (const [one, item] of this.cards) item.querySelector("input").checked = one === name;
  }
}

function card({ name, title, description }) {
  const label = Object.assign(document.createElement("label"), { className: "card", title: description });
  const input = Object.assign(document.createElement("input"), { type: "radio", name: "instrument", value: name });
  const picture = document.getElementById("instrument").cloneNode();
  picture.removeAttribute("id");
  draw(picture, name);
  label.append(input, picture, Object.assign(document.createElement("strong"), { textContent: title }));
  const { like } = sketchOf(name);
  if (like) label.append(Object.assign(document.createElement("span"), { textContent: `like ${like}` }));
  return label;
}
