"""What an assessor gets: requirements traced both ways, and claims with what shows them."""
