"""The thesis' chapter 5 in 40 lines: thirty hands hold a cylinder and prisms (Xie 2014, 5.4 and 5.5).

    python3 examples/python/chapter5.py [FOLDER [HANDS]]

Figures as in the thesis: hands drawn (fig. 5-7), contact area on a 35 mm cylinder, and peak and
average pressure on prisms with fillets of 3 and 10 mm and with redesign 1 (5.5.4). As there, the
redesigns are held in the posture of the original (5.5.3), so that a smaller body is held with less
force; docs/method/redesign.md compares at equal force.
"""

import pathlib
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import palmar

out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "chapter5")
hands = int(sys.argv[2]) if len(sys.argv) > 2 else 30
out.mkdir(parents=True, exist_ok=True)
prism = "made: prism width_mm=35 depth_mm=35 length_mm=130 fillet_mm=3"
palmar.redesign.features(prism, out / "fillet10", vary="fillet:long=10", hands=hands, seed=2014, hold_posture="kept")
palmar.redesign.press(prism, out / "redesign1", hands=hands, seed=2014, hold_posture="kept", pictures=False)
study = palmar.study.run(products="made: cylinder diameter_mm=35 length_mm=130", population="xie2014", hands=hands,
                         limit_depths=True, seed=2014, out=out / "chapter5.palmar", progress=True)
people = palmar.population.sample("xie2014", hands=500, design="random", seed=2014)
grasps = palmar.study.grasps(study)
stores = {name: palmar.study.grasps(out / folder / "redesign.palmar")
          for name, folder in (("fillet 10 mm", "fillet10"), ("redesign 1", "redesign1"))}

figure, ((sample, area), (peak, mean)) = plt.subplots(2, 2, figsize=(11, 8), layout="constrained")
sample.plot(people["hand_length_mm"], people["hand_circumference_mm"], ".", color="0.6", ms=4)
sample.plot(grasps["hand_length_mm"], grasps["hand_circumference_mm"], "o", color="C3", ms=4)
sample.set(xlabel="hand length, mm", ylabel="hand circumference, mm", title=f"500 people; {hands} hands of the study")
area.hist(grasps["contact_area_mm2"], bins=10, color="C0", edgecolor="white")
area.set(xlabel="contact area on the cylinder, mm²", ylabel="hands", title="Contact area")
for axes, key, title in ((peak, "peak_pressure_cells_mpa", "Peak pressure on sensor cells"),
                         (mean, "mean_pressure_mpa", "Average pressure")):
    first = next(iter(stores.values()))
    values = [first[key][first["product"] == first["product"][0]]]  # the original
    values += [one[key][one["product"] != one["product"][0]] for one in stores.values()]
    edges = np.linspace(np.nanmin(np.concatenate(values)), np.nanmax(np.concatenate(values)), 13)
    axes.hist(values, bins=edges, label=["fillet 3 mm", *stores], color=["C3", "C1", "C0"])
    axes.set(xlabel="MPa", ylabel="hands", title=title)
    axes.legend(frameon=False)
figure.savefig(out / "chapter5.png", dpi=120)
