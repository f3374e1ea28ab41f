"""Programs outside, as children that end with us; and what is kept between calls."""
