"""Figures and goals in words, the same on the terminal and in the report."""

from scoring.figures import Rate

from . import goals


def figure_text(figure):
    """A figure as a person reads it."""
    if figure is None:
        return "no case"
    if isinstance(figure, float):
        return f"{figure:.3g}"
    return str(figure).strip()


def limit_text(goal):
    is_share = goal.figure in (goals.EFFECT, goals.JOINT, goals.ALARMS, goals.CLAIMS)
    limit = f"{100 * goal.limit:g} %" if is_share else f"{goal.limit:g}"
    return f"{'≥' if goal.at_least else '≤'} {limit}"


def headline(found):
    missed = [goal.figure for goal, _, met in goals.judged(found) if met is False]
    effect = found[goals.EFFECT]
    first = "No case had anything concealed"
    if isinstance(effect, Rate) and effect.n:
        first = f"In {effect.k} of {effect.n} cases the first thing named is what was concealed"
    if missed:
        return f"{first}; not reached: {'; '.join(missed)}."
    return f"{first}; every goal that was judged is reached."
