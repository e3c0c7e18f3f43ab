"""Reads written files with the readers of other programs: GeoJSON with GDAL, DXF with ezdxf, SVG with svgelements.

usage: read_back.py FOLDER          (needs: pip install fiona ezdxf svgelements)

Every file under FOLDER must open, hold something, and lie where its page is.
"""

import math
import pathlib
import sys

import ezdxf
import fiona
import svgelements


def geojson(path):
    with fiona.open(path) as layer:
        features = [feature for feature in layer if feature["geometry"] is not None]
        assert len(features) == len(layer), "a feature without geometry"
        kinds = {feature["geometry"]["type"] for feature in features}
        assert kinds <= {"LineString", "Polygon"}, kinds
        assert all("node" in feature["properties"] for feature in features)
        west, south, east, north = layer.bounds
        if layer.crs and layer.crs.to_epsg() == 4326:
            assert -180 <= west <= east <= 180 and -90 <= south <= north <= 90, layer.bounds
        return len(features)


def dxf(path):
    document = ezdxf.readfile(path)
    errors = document.audit().errors
    assert not errors, errors[:3]
    return len(document.modelspace())


def svg(path):
    drawing = svgelements.SVG.parse(path)
    shapes = [shape for shape in drawing.elements() if isinstance(shape, svgelements.Shape)]
    boxes = [box for shape in shapes if (box := shape.bbox()) is not None]
    assert all(math.isfinite(number) for box in boxes for number in box)
    return len(shapes)


def main(folder):
    readers = {".geojson": geojson, ".dxf": dxf, ".svg": svg}
    passed, failed = 0, 0
    for path in sorted(pathlib.Path(folder).rglob("*")):
        reader = readers.get(path.suffix)
        if reader is None:
            continue
        try:
            count = reader(path)
            assert count > 0, "nothing in it"
            passed += 1
        except Exception as error:  # whatever a foreign reader says is a finding
            failed += 1
            print(f"{path}: {type(error).__name__}: {error}")
    print(f"{passed} passed, {failed} failed")
    return failed > 0 or passed == 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
