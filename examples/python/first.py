"""A handle in the template hand: how firmly, how large, where it presses.

    python3 examples/python/first.py
"""

import palmar

round_handle = palmar.product.make("cylinder", diameter_mm=35, length_mm=130)
square_handle = palmar.product.make("prism", width_mm=35, depth_mm=35, length_mm=130, fillet_mm=3)

result = palmar.assess(round_handle, square_handle, grip_force_n=60, progress=True)
print(result.sentence)
for one in result:
    print(f"{one.product.name}: {one.hold}; grip force {one.grip_force_n:.0f} N, "
          f"{one.contact_area_mm2:.0f} mm2 in contact, "
          f"hardest {one.peak_pressure_cells_mpa:.3f} MPa on a sensor cell")

regions = result.regions()  # a dict of columns: pandas.DataFrame(regions) makes a frame of it
is_square = (regions["product"] == square_handle.name) & (regions["region"] != "total")
hardest = regions["peak_pressure_cells_mpa"][is_square].argmax()
print("The square handle presses hardest on:", regions["region"][is_square][hardest])
