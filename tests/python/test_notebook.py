"""The notebook of examples, cell by cell as a notebook runs it: Jupyter is not needed."""

import json
import os


def test_the_notebook_runs_and_its_errors_fall():
    with open(os.path.join(os.environ["STROMBOLI_EXAMPLES"], "convergence.ipynb")) as file:
        notebook = json.load(file)
    names = {}
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            exec(compile(cell["source"], "convergence.ipynb", "exec"), names)
    mean, half, slope = (names[name] for name in ("mean", "half", "slope"))
    # All errors fall; where nothing but chance finds the small lamp they are the largest by far.
    for direct in names["SETTINGS"]:
        assert list(mean[direct]) == sorted(mean[direct], reverse=True)
        assert slope[direct] < -0.6
    assert (mean["mis"] + half["mis"] < mean["bsdf"] - half["bsdf"]).all()
    assert (mean["lights"] + half["lights"] < mean["hemisphere"] - half["hemisphere"]).all()
