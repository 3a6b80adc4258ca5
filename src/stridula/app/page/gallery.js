// The cases as cards with pictures, one of which is played.
import { draw, sketchOf } from "./sketches.js";

export class Gallery {
  constructor(presets, choose) {
    const [dialog, cards] = [document.getElementById("gallery"), document.getElementById("cards")];
    this.cards = new Map(presets.map((one) => [one.name, card(one)]));
    cards.replaceChildren(...this.cards.values());
    // Keys move through the cards and play each; pressing a card chooses it.
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

  // Mark the played case, none for the user's own.
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
