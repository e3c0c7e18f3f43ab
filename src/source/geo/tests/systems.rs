//! Coordinate systems against PROJ 9.5.1, always longitude first.

use crate::geo::crs::{Crs, CrsError, Transform};
use crate::geo::datums::definition_of_code;
use fretwork_geometry::Point;

/// EPSG code, place on WGS 84, coordinates.
const RECORDED: &[(u32, [f64; 2], [f64; 2])] = &[
    (32616, [-84.3, 36.57], [741607.5493, 4050566.0143]),
    (32616, [-90.0, 0.5], [166034.0983, 55341.3882]),
    (2154, [2.35, 48.85], [652301.5648, 6861302.7259]),
    (2154, [-4.5, 43.2], [90925.2050, 6262367.5170]),
    (3035, [10.0, 52.0], [4321000.0, 3210000.0]),
    (3035, [-8.5, 38.7], [2719023.4771, 1930638.6179]),
    (3035, [24.1, 60.2], [5099080.2662, 4199928.5375]),
    (3857, [-84.3, 36.57], [-9384233.0739, 4379338.6187]),
    (3857, [179.5, -70.0], [19981848.5974, -11068715.6594]),
    (3395, [12.5, 41.9], [1391493.6349, 5117468.3535]),
    (5070, [-96.0, 40.0], [0.0, 1886977.5649]),
    (5070, [-120.0, 47.5], [-1800535.1954, 2951547.2191]),
    (3995, [30.0, 80.0], [544589.7278, -943257.0779]),
    (3995, [-150.0, 70.0], [-1097247.1238, 1900487.7669]),
    (2056, [7.44, 46.95], [2600104.1095, 1199879.6282]),
    (2056, [9.83, 46.5], [2783545.4354, 1152651.3251]),
    (25832, [9.99, 53.55], [565590.9407, 5933912.1654]),
    (6933, [100.0, 20.0], [9648628.0251, 2501271.8625]),
    (3844, [26.1, 44.43], [587700.4289, 326177.2217]),
    (27700, [-2.0, 53.0], [400097.2360, 344742.0723]),
    (27700, [-5.0, 50.2], [185999.4876, 37639.1775]),
    (28992, [6.5, 53.0], [229705.1173, 557580.6278]),
    (28992, [5.4, 52.15], [155875.8204, 462424.6079]),
];

#[test]
fn places_are_those_of_proj_to_the_millimetre_and_come_back() {
    for (code, place, expected) in RECORDED {
        let to = Transform::new(Crs::wgs84().unwrap(), Crs::of_epsg(*code).unwrap());
        let (place, expected) = (Point::from(*place), Point::from(*expected));
        let found = to.apply(place).unwrap();
        assert!(
            found.distance(expected) < 1e-3,
            "EPSG:{code}: {found:?}, PROJ has {expected:?}"
        );
        let back = to.inverse().apply(found).unwrap();
        // A shift of datum by three or seven parameters comes back to a millimetre.
        assert!(back.distance(place) < 2e-8, "EPSG:{code}: {back:?}");
    }
}

const UTM_16: &str = r#"PROJCS["WGS_1984_UTM_Zone_16N",GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["False_Easting",500000.0],PARAMETER["False_Northing",0.0],PARAMETER["Central_Meridian",-87.0],PARAMETER["Scale_Factor",0.9996],PARAMETER["Latitude_Of_Origin",0.0],UNIT["Meter",1.0]]"#;

#[test]
fn a_system_is_the_same_however_it_is_written() {
    let utm = Crs::of_epsg(32616).unwrap();
    let coded = format!(
        "{},AUTHORITY[\"EPSG\",\"32616\"]]",
        &UTM_16[..UTM_16.len() - 1]
    );
    for text in [
        UTM_16,
        &coded,
        "EPSG:32616",
        "urn:ogc:def:crs:EPSG::32616",
        "http://www.opengis.net/def/crs/EPSG/0/32616",
        "+proj=utm +zone=16 +datum=WGS84",
        "+proj=tmerc +lat_0=0 +lon_0=-87 +k=0.9996 +x_0=500000 +y_0=0 +ellps=WGS84 +units=m",
    ] {
        let crs = Crs::parse(text).unwrap();
        assert!(crs.is_same(&utm) && utm.is_same(&crs), "{text}");
        crs.check_plane().unwrap();
    }
    // WGS 84, NAD83 and ETRS89 are one datum.
    assert!(Crs::of_epsg(26916).unwrap().is_same(&utm));
    assert!(
        Crs::parse("OGC:CRS84")
            .unwrap()
            .is_same(&Crs::of_epsg(4258).unwrap())
    );
    for other in ["EPSG:32617", "EPSG:3857", "EPSG:4326"] {
        assert!(!Crs::parse(other).unwrap().is_same(&utm), "{other}");
    }
}

#[test]
fn what_is_no_plane_is_refused_with_the_reason() {
    let refused = |text: &str| Crs::parse(text).unwrap().check_plane().unwrap_err();
    assert!(matches!(refused("EPSG:4326"), CrsError::Geographic(_)));
    // Florida East in feet.
    assert!(matches!(refused("EPSG:2236"), CrsError::Unit { .. }));
    assert_eq!(
        Crs::parse("EPSG:999999").unwrap_err(),
        CrsError::Unknown("EPSG:999999".into())
    );
    let nested = "PROJCS[".repeat(5000);
    for text in [
        "",
        "EPSG:",
        "somewhere",
        "+proj=nowhere",
        "PROJCS[",
        &nested,
        "PROJCS[\"a\"]",
        "LOCAL_CS[\"a\",UNIT[\"m\",1]]",
    ] {
        assert!(Crs::parse(text).is_err(), "{text}");
    }
}

#[test]
fn places_that_a_system_lacks_have_none() {
    let wgs84 = Crs::wgs84().unwrap();
    let mercator = Transform::new(wgs84.clone(), Crs::of_epsg(3395).unwrap());
    let pole = mercator.apply(Point::new(0.0, 90.0));
    assert!(pole.is_none_or(|p| p.y > 1e8), "{pole:?}");
    assert_eq!(mercator.apply(Point::new(0.0, 95.0)), None);
    assert!(Crs::of_epsg(4267).unwrap().needs_grid());
    // Longitudes that run on are the same places, and those that come back lie in -180 to 180.
    let utm = Transform::new(wgs84, Crs::of_epsg(32601).unwrap());
    let (a, b) = (Point::new(-179.0, 50.0), Point::new(181.0, 50.0));
    let (a, b) = (utm.apply(a).unwrap(), utm.apply(b).unwrap());
    assert!(a.distance(b) < 1e-6);
    assert!((utm.inverse().apply(b).unwrap().x + 179.0).abs() < 1e-9);
}

/// A transverse Mercator by parameters alone, with the datum of this name.
fn by_name(datum: &str, ellipsoid: &str, projection: &str) -> String {
    format!(
        "PROJCS[\"x\",GEOGCS[\"g\",DATUM[\"{datum}\",SPHEROID[\"s\",{ellipsoid}]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],{projection},UNIT[\"metre\",1]]"
    )
}

fn parameters([lat, lon, scale, east, north]: [f64; 5]) -> String {
    let named = [
        ("latitude_of_origin", lat),
        ("central_meridian", lon),
        ("scale_factor", scale),
        ("false_easting", east),
        ("false_northing", north),
    ];
    let parts = named.map(|(name, value)| format!("PARAMETER[\"{name}\",{value}]"));
    parts.join(",")
}

#[test]
fn datums_are_known_by_their_names() {
    let airy = "6377563.396,299.3249646";
    let bessel = "6377397.155,299.1528128";
    let british = parameters([49.0, -2.0, 0.9996012717, 400_000.0, -100_000.0]);
    let german = parameters([0.0, 9.0, 1.0, 3_500_000.0, 0.0]);
    let greek = parameters([0.0, 24.0, 0.9996, 500_000.0, 0.0]);
    let italian = parameters([0.0, 9.0, 0.9996, 1_500_000.0, 0.0]);
    let utm = parameters([0.0, -87.0, 0.9996, 500_000.0, 0.0]);
    for (code, datum, ellipsoid, projection) in [
        (27700, "OSGB_1936", airy, &british),
        (27700, "D_OSGB_1936", airy, &british),
        (
            27700,
            "Ordnance Survey of Great Britain 1936",
            airy,
            &british,
        ),
        (31467, "D_Deutsches_Hauptdreiecksnetz", bessel, &german),
        (2100, "D_GGRS_1987", "6378137,298.257222101", &greek),
        (3003, "Monte_Mario", "6378388,297", &italian),
        (32616, "D_WGS_1984", "6378137,298.257223563", &utm),
    ] {
        let crs = Crs::parse(&by_name(datum, ellipsoid, projection)).unwrap();
        let known = Crs::of_epsg(code).unwrap();
        assert!(crs.is_same(&known), "{datum}: {}", crs.text());
        assert_eq!(crs.doubt(), None, "{datum}");
    }
    // With a shift of its own, a datum has that.
    let own = by_name(
        "OSGB_1936",
        &format!("{airy}],TOWGS84[1,2,3,0,0,0,0"),
        &british,
    );
    assert!(
        !Crs::parse(&own)
            .unwrap()
            .is_same(&Crs::of_epsg(27700).unwrap())
    );
    let doubt = |datum, ellipsoid| {
        Crs::parse(&by_name(datum, ellipsoid, &utm))
            .unwrap()
            .doubt()
    };
    let grid = doubt("D_North_American_1927", "6378206.4,294.9786982").unwrap();
    assert!(grid.contains("grid"), "{grid}");
    let unknown = doubt("Middle Earth", bessel).unwrap();
    assert!(unknown.contains("Middle Earth"), "{unknown}");
    // What has the ellipsoid of WGS 84 is taken for it.
    assert_eq!(doubt("Middle Earth", "6378137,298.257223563"), None);
}

#[test]
fn the_web_and_switzerland_are_known_by_their_parameters() {
    let web = "PROJCS[\"w\",GEOGCS[\"g\",DATUM[\"WGS_1984\",SPHEROID[\"s\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"Mercator_1SP\"],PARAMETER[\"central_meridian\",0],PARAMETER[\"scale_factor\",1],PARAMETER[\"false_easting\",0],PARAMETER[\"false_northing\",0],UNIT[\"metre\",1],EXTENSION[\"PROJ4\",\"+proj=merc +a=6378137 +b=6378137 +lat_ts=0 +lon_0=0 +x_0=0 +y_0=0 +k=1 +units=m +nadgrids=@null +wktext +no_defs\"]]";
    let crs = Crs::parse(web).unwrap();
    assert!(crs.is_same(&Crs::of_epsg(3857).unwrap()));
    assert_eq!(crs.code(), Some(3857));
    let degree = "ANGLEUNIT[\"degree\",0.0174532925199433]";
    let parameter =
        |name: &str, value: f64, unit: &str| format!("PARAMETER[\"{name}\",{value},{unit}]");
    let metre = "LENGTHUNIT[\"metre\",1]";
    let conversion = [
        parameter(
            "Latitude of projection centre",
            46.952_405_555_555_6,
            degree,
        ),
        parameter(
            "Longitude of projection centre",
            7.439_583_333_333_33,
            degree,
        ),
        parameter("Azimuth at projection centre", 90.0, degree),
        parameter("Angle from Rectified to Skew Grid", 90.0, degree),
        parameter(
            "Scale factor at projection centre",
            1.0,
            "SCALEUNIT[\"unity\",1]",
        ),
        parameter("Easting at projection centre", 2_600_000.0, metre),
        parameter("Northing at projection centre", 1_200_000.0, metre),
    ];
    let swiss = format!(
        "PROJCRS[\"x\",BASEGEOGCRS[\"CH1903+\",DATUM[\"CH1903+\",ELLIPSOID[\"Bessel 1841\",6377397.155,299.1528128,{metre}]],PRIMEM[\"Greenwich\",0,{degree}]],CONVERSION[\"c\",METHOD[\"Hotine Oblique Mercator (variant B)\",ID[\"EPSG\",9815]],{}],CS[Cartesian,2],AXIS[\"(E)\",east],AXIS[\"(N)\",north],{metre}]",
        conversion.join(",")
    );
    let crs = Crs::parse(&swiss).unwrap();
    assert!(crs.is_same(&Crs::of_epsg(2056).unwrap()), "{}", crs.text());
    assert_eq!(crs.code(), Some(2056));
}

#[test]
fn systems_without_a_code_have_that_of_their_equals() {
    for code in [32616, 26916, 25832, 3035, 2154, 27700, 28992, 5070] {
        let text = definition_of_code(code).unwrap();
        let found = Crs::parse(&text).unwrap().code().unwrap();
        let found = Crs::of_epsg(found).unwrap();
        assert!(found.is_same(&Crs::of_epsg(code.into()).unwrap()), "{code}");
        assert_eq!(Crs::parse(&text).unwrap().epsg(), None);
    }
    for code in [32616, 26916, 25832, 2154, 27700] {
        let text = crs_definitions::from_code(code).unwrap().proj4;
        assert_eq!(Crs::parse(text).unwrap().code(), Some(code.into()));
    }
}
