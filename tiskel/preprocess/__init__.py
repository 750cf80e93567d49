"""What can be done to a cloud before the first stage."""
